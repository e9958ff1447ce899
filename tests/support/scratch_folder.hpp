// An empty folder that exists as long as the object, for tests that write files.
// It is removed even when the test fails; nothing outside of it is touched.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace corridor::testing {

// Where files lie in memory, or the temporary folder where there is no such place. For small files
// only: containers often have 64 MB of it.
inline std::filesystem::path memory_folder() {
  const std::filesystem::path folder = "/dev/shm";
  const bool is_usable = ::access(folder.c_str(), W_OK | X_OK) == 0;
  return is_usable ? folder : std::filesystem::temp_directory_path();
}

class ScratchFolder {
 public:
  ScratchFolder() : ScratchFolder(std::filesystem::temp_directory_path()) {}
  explicit ScratchFolder(const std::filesystem::path& parent) {
    // mkdtemp() replaces the six letters at the end.
    std::string name = (parent / "corridor-").string() + std::string(6, 'X');
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder at " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

  // Writes a file inside, with the folders on its way; returns its full path.
  std::filesystem::path write(const std::filesystem::path& relative,
                              std::string_view content) const {
    const std::filesystem::path file = path_ / relative;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace corridor::testing
