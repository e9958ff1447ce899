// Files that are whole or not there: content goes to a temporary name in the same folder, is
// flushed to the disk and renamed. Every writer of the suite that leaves a file behind goes through
// here.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

// Replaces or creates `path`. On an Error nothing is left behind and an older file is untouched.
Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view content);

// For libraries that write by themselves: `write` is given the temporary path (whose suffix is that
// of `path`) and leaves a complete file there.
Result<void> write_file_atomically(
    const std::filesystem::path& path,
    const std::function<Result<void>(const std::filesystem::path& temporary)>& write);

}  // namespace corridor::formats
