// The right to write into a results folder, held by one run at a time.
#pragma once

#include <filesystem>

#include "slam/core/result.hpp"

namespace corridor::runner {

class FolderLock {
 public:
  // Creates the folder if it is not there. An Error if another process holds its lock. The kernel
  // lets go of the lock when its holder ends, however that happens.
  static Result<FolderLock> take(const std::filesystem::path& folder);

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  FolderLock(std::filesystem::path folder, int descriptor);

  std::filesystem::path folder_;
  int descriptor_ = -1;
};

}  // namespace corridor::runner
