#include "bench/results/digest.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>
#include <cstddef>

namespace corridor::results {

std::string short_digest(std::string_view text) {
  constexpr std::size_t kNumBytes = 6;
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  std::string hex;
  for (std::size_t i = 0; i < kNumBytes; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace corridor::results
