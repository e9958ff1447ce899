// Files with known values, made outside of this code base: the seeds of tests/fuzz.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats::test {

inline std::filesystem::path golden_file(const std::string& name) {
  return std::filesystem::path(CORRIDOR_SOURCE_DIR) / "tests/fuzz/corpus" / name;
}

// The two parts of a file with a line `%%` between them.
inline std::pair<std::string, std::string> golden_parts(const std::string& name) {
  const std::string text = read_text(golden_file(name));
  const std::string separator = "\n%%\n";
  const std::size_t end = text.find(separator);
  return {text.substr(0, end), text.substr(end + separator.size())};
}

}  // namespace corridor::formats::test
