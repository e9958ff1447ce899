// Counts the program's allocations: takes the place of glibc's malloc(), which stands behind
// operator new, Eigen, CHOLMOD and CAMD. To be included by one file of a program.
#pragma once

#include <atomic>
#include <cstdlib>

namespace corridor::testing {

inline std::atomic<int> num_allocations{0};

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kCountsAllocations = false;  // AddressSanitizer brings its own malloc()
#else
inline constexpr bool kCountsAllocations = true;
#endif

}  // namespace corridor::testing

#if !defined(__SANITIZE_ADDRESS__)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++corridor::testing::num_allocations;
  return __libc_malloc(size);
}
#endif
