// The checksum of a file as its catalogue entry counts it. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>

#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::catalog {

// Of the file's bytes, or of its content without gzip (DataFile::is_sum_of_content). Of a packed
// file that is truncated or corrupted the sum of its bytes: it differs, which is the answer.
Result<std::string> checksum_of(const std::filesystem::path& path, const DataFile& file);

}  // namespace corridor::catalog
