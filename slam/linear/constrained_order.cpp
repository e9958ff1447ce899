#include "slam/linear/constrained_order.hpp"

#include <camd.h>

#include <algorithm>
#include <numeric>

#include "slam/core/expect.hpp"

namespace corridor::linear {

void constrained_minimum_degree_order(const BlockPattern& pattern, std::span<int> groups,
                                      std::vector<int>& order) {
  const int n = pattern.num_variables();
  CORRIDOR_EXPECT(groups.size() == static_cast<std::size_t>(n));
  order.resize(groups.size());
  if (pattern.rows.empty()) {  // which CAMD takes for a missing argument
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return groups[static_cast<std::size_t>(a)] < groups[static_cast<std::size_t>(b)];
    });
    return;
  }
  const int status = camd_order(n, pattern.starts.data(), pattern.rows.data(), order.data(),
                                nullptr, nullptr, groups.data());
  CORRIDOR_ENSURE(status == CAMD_OK || status == CAMD_OK_BUT_JUMBLED);
}

}  // namespace corridor::linear
