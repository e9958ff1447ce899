#include "slam/linear/minimum_degree.hpp"

#include <amd.h>

#include <new>

#include "slam/core/expect.hpp"

namespace corridor::linear {

std::vector<int> minimum_degree_order(const BlockPattern& pattern) {
  std::vector<int> order(to_index(pattern.num_variables()));
  constexpr int kNoRows = 0;  // AMD takes a null pointer for a mistake
  const int* rows = pattern.rows.empty() ? &kNoRows : pattern.rows.data();
  const int status = amd_order(pattern.num_variables(), pattern.starts.data(), rows, order.data(),
                               nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  CORRIDOR_ENSURE(status == AMD_OK || status == AMD_OK_BUT_JUMBLED);
  return order;
}

}  // namespace corridor::linear
