#include "bench/runner/build_id.hpp"

#include "datasets/catalog/sha256.hpp"

namespace corridor::runner {

std::optional<std::string> build_id() {
  constexpr std::size_t kNumDigits = 12;
  const Result<std::string> sha256 = catalog::sha256_of_file("/proc/self/exe");
  if (!sha256) return std::nullopt;
  return sha256->substr(0, kNumDigits);
}

}  // namespace corridor::runner
