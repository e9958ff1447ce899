#include "reports/html/csp_hash.hpp"

#include "datasets/catalog/sha256.hpp"
#include "reports/escape.hpp"

namespace corridor::html {

std::string csp_hash(const std::string& content) {
  const catalog::Sha256 digest = catalog::sha256_of(content);
  return "sha256-" + reports::base64({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

}  // namespace corridor::html
