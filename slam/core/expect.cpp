#include "slam/core/expect.hpp"

#include <cstdio>
#include <cstdlib>

namespace corridor::detail {

void contract_broken(const char* file, int line, const char* text) {
  std::fprintf(stderr, "%s:%d: contract broken: %s\n", file, line, text);
  std::abort();
}

}  // namespace corridor::detail
