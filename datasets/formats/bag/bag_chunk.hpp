// The content of one chunk of a ROS 1 bag: as it stands, or decompressed by bzip2 or LZ4 to exactly
// the size that the chunk states, so that a bomb stops at its own word. Internal to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

// rosbag's own chunks have 768 KiB; a recorder may set more. rosbag allocates what a chunk states.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{64} << 20;

// `compression` is "none", "bz2" or "lz4". An Error for another one, a size beyond the cap, data
// that are corrupted or truncated, that give more or fewer bytes than stated or go on behind their
// end.
Result<std::string> chunk_content(std::string_view data, std::string_view compression,
                                  std::size_t stated_size, const std::string& where);

}  // namespace corridor::formats
