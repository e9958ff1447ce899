// Whole files in memory, gzip-compressed or not, with a cap on what they may grow to.
// A file that is truncated, corrupted or followed by something else is an Error, never a partial
// read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

// More than any log of the suite, little enough for a laptop: a gzip bomb stops here.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

// The content, decompressed if the file starts with gzip's magic number.
Result<std::string> read_file_bytes(const std::filesystem::path& path,
                                    std::size_t max_bytes = kMaxFileBytes);

// One gzip member without name and time, so that equal content gives equal bytes.
Result<std::string> gzip(std::string_view content);

}  // namespace corridor::formats
