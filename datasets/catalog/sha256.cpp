#include "datasets/catalog/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::catalog {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

struct FreeDigest {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

// Takes bytes piece by piece. A libcrypto that knows no SHA-256 is a broken installation.
class Hasher {
 public:
  Hasher() : context_(EVP_MD_CTX_new()) {
    CORRIDOR_ENSURE(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void take(std::string_view bytes) {
    CORRIDOR_ENSURE(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }

  [[nodiscard]] Sha256 finish() {
    Sha256 digest{};
    CORRIDOR_ENSURE(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) == 1);
    return digest;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, FreeDigest> context_;
};

}  // namespace

Sha256 sha256_of(std::string_view bytes) {
  Hasher hasher;
  hasher.take(bytes);
  return hasher.finish();
}

std::string to_hex(const Sha256& digest) { return fmt::format("{:02x}", fmt::join(digest, "")); }

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(ErrorCode::kUnreadable, "cannot be read", path.string());
  Hasher hasher;
  std::vector<char> chunk(kChunkBytes);
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    hasher.take({chunk.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (file.bad()) return fail(ErrorCode::kUnreadable, "cannot be read to its end", path.string());
  return to_hex(hasher.finish());
}

}  // namespace corridor::catalog
