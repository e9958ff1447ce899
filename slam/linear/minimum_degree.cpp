#include "slam/linear/minimum_degree.hpp"

#include <amd.h>
#include <camd.h>

#include <new>

#include "slam/core/expect.hpp"

namespace corridor::linear {

namespace {

// AMD and CAMD take a null pointer for a mistake.
const int* rows_of(const BlockPattern& pattern) {
  static constexpr int kNoRows = 0;
  return pattern.rows.empty() ? &kNoRows : pattern.rows.data();
}

}  // namespace

std::vector<int> minimum_degree_order(const BlockPattern& pattern) {
  std::vector<int> order(to_index(pattern.num_variables()));
  const int status = amd_order(pattern.num_variables(), pattern.starts.data(), rows_of(pattern),
                               order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  CORRIDOR_ENSURE(status == AMD_OK || status == AMD_OK_BUT_JUMBLED);
  return order;
}

void constrained_minimum_degree_order(const BlockPattern& pattern, std::span<const int> groups,
                                      std::vector<int>& order) {
  CORRIDOR_EXPECT(groups.size() == to_index(pattern.num_variables()));
  order.resize(groups.size());
  const int status =
      camd_order(pattern.num_variables(), pattern.starts.data(), rows_of(pattern), order.data(),
                 nullptr, nullptr, const_cast<int*>(groups.data()));  // which it only reads
  if (status == CAMD_OUT_OF_MEMORY) throw std::bad_alloc();
  CORRIDOR_ENSURE(status == CAMD_OK || status == CAMD_OK_BUT_JUMBLED);
}

}  // namespace corridor::linear
