#include "reports/html/csp_hash.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstddef>

#include "reports/escape.hpp"

namespace corridor::html {

std::string csp_hash(const std::string& content) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  EVP_Digest(content.data(), content.size(), digest.data(), &length, EVP_sha256(), nullptr);
  return "sha256-" +
         reports::base64({reinterpret_cast<const char*>(digest.data()), std::size_t{length}});
}

}  // namespace corridor::html
