// From one string of bytes to the files that a reader opens: several parts of an input, and files
// that lie in memory.
#pragma once

#include <filesystem>
#include <string_view>

namespace corridor::fuzz {

// Between the parts of an input.
inline constexpr std::string_view kSeparator = "\n%%\n";

struct TwoParts {
  std::string_view first;
  std::string_view second;  // empty without a separator
};

TwoParts split(std::string_view bytes);

// A file in memory that lasts as long as the object. It lies at a path that inputs can know: a
// map's yaml names its image "101", a scenario its map.
class MemoryFile {
 public:
  static constexpr int kFirst = 100;
  static constexpr int kSecond = 101;
  static constexpr int kThird = 102;

  // Each place holds one file at a time.
  explicit MemoryFile(std::string_view bytes, int place = kFirst);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const;

 private:
  int place_;
};

}  // namespace corridor::fuzz
