#include "datasets/catalog/checksum.hpp"

#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/file_bytes.hpp"

namespace corridor::catalog {

Result<std::string> checksum_of(const std::filesystem::path& path, const DataFile& file) {
  if (!file.is_sum_of_content) return sha256_of_file(path);
  const auto content = formats::read_file_bytes(path);
  if (content) return to_hex(sha256_of(*content));
  if (content.error().code == ErrorCode::kMalformed) return sha256_of_file(path);
  return tl::make_unexpected(content.error());
}

}  // namespace corridor::catalog
