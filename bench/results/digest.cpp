#include "bench/results/digest.hpp"

#include <cstddef>

#include "datasets/catalog/sha256.hpp"

namespace corridor::results {

std::string short_digest(std::string_view text) {
  constexpr std::size_t kNumDigits = 12;
  return catalog::to_hex(catalog::sha256_of(text)).substr(0, kNumDigits);
}

}  // namespace corridor::results
