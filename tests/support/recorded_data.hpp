// Finds a file of the recorded data in $CORRIDOR_BENCH_DATA.
// A test that gets nullopt skips itself with missing_data_message(); it never passes silently.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace corridor::testing {

inline std::optional<std::filesystem::path> recorded_file(const std::filesystem::path& relative) {
  const char* folder = std::getenv("CORRIDOR_BENCH_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  std::filesystem::path file = std::filesystem::path(folder) / relative;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file;
}

inline std::string missing_data_message(const std::filesystem::path& relative) {
  return relative.string() + " is not in $CORRIDOR_BENCH_DATA; set it to the folder of the data";
}

}  // namespace corridor::testing
