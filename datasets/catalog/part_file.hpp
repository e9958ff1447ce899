// A download in progress: the bytes that have arrived, under a name of its own beside the file they
// will become, so that a later attempt goes on where this one stopped. Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::catalog {

// Holds the file's lock as long as it lives: two programs never write to one part.
class PartFile {
 public:
  // Opens or creates `path`, keeping what is there. An Error if another program has it.
  static Result<PartFile> open(std::filesystem::path path);
  ~PartFile();
  PartFile(PartFile&& other) noexcept;
  PartFile& operator=(PartFile&&) = delete;
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

  Result<void> append(std::string_view bytes);
  // Forgets what is there.
  Result<void> clear();
  // To the disk and onto `target`; the part is no more.
  Result<void> rename_to(const std::filesystem::path& target);
  void remove();

 private:
  PartFile(std::filesystem::path path, int descriptor, std::uint64_t size_bytes)
      : path_(std::move(path)), descriptor_(descriptor), size_bytes_(size_bytes) {}
  [[nodiscard]] tl::unexpected<Error> failure(const char* what) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace corridor::catalog
