// One chunk of a bag: a letter for its compression, the stated size in two bytes, the data.
#include "datasets/formats/bag/bag_chunk.hpp"

#include <cstdint>

#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {
namespace {

std::string_view compression_of(char letter) {
  if (letter == 'b') return "bz2";
  if (letter == 'l') return "lz4";
  return letter == 'n' ? "none" : "zip";
}

}  // namespace

bool bag_chunk(std::string_view bytes) {
  constexpr std::size_t kHeadBytes = 3;
  if (bytes.size() < kHeadBytes) return false;
  const std::size_t stated_size =
      static_cast<std::uint8_t>(bytes[1]) * std::size_t{256} + static_cast<std::uint8_t>(bytes[2]);
  const auto content = formats::chunk_content(bytes.substr(kHeadBytes), compression_of(bytes[0]),
                                              stated_size, "chunk");
  if (!content) return false;
  CORRIDOR_EXPECT(content->size() == stated_size);
  return true;
}

}  // namespace corridor::fuzz
