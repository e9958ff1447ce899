// Whole files, gzip-compressed or not; what was read comes back from its own compression.
#include "datasets/formats/file_bytes.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool gzip(std::string_view bytes) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 16;
  const MemoryFile file(bytes);
  const auto content = formats::read_file_bytes(file.path(), kMaxBytes);
  if (!content) return false;
  CORRIDOR_EXPECT(content->size() <= kMaxBytes);
  const auto compressed = formats::gzip(*content);
  CORRIDOR_EXPECT(compressed.has_value());
  const MemoryFile again(*compressed, MemoryFile::kSecond);
  const auto read = formats::read_file_bytes(again.path(), kMaxBytes);
  CORRIDOR_EXPECT(read.has_value() && *read == *content);
  return true;
}

}  // namespace corridor::fuzz
