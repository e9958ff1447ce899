#include "bench/runner/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

fs::path lock_file(const fs::path& folder) { return folder / ".lock"; }

// The holder before us removes its file when it is done: a lock on that file is worth nothing.
bool is_still_there(int descriptor, const fs::path& file) {
  struct stat held {};
  struct stat named {};
  return fstat(descriptor, &held) == 0 && stat(file.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

tl::unexpected<Error> not_writable(const std::string& why, const fs::path& folder) {
  return fail(ErrorCode::kUnreadable, why, folder.string(), "a folder that can be written");
}

}  // namespace

Result<FolderLock> FolderLock::take(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return not_writable(error.message(), folder);
  while (true) {
    const int descriptor = open(lock_file(folder).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0) return not_writable(std::strerror(errno), folder);
    const int reason = flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (reason == 0 && is_still_there(descriptor, lock_file(folder))) {
      return FolderLock(folder, descriptor);
    }
    close(descriptor);
    if (reason == 0) continue;
    if (reason != EWOULDBLOCK) return not_writable(std::strerror(reason), folder);
    return fail(ErrorCode::kInvalid, "another run is writing to this folder", folder.string(),
                "its end, or another --out");
  }
}

FolderLock::FolderLock(fs::path folder, int descriptor)
    : folder_(std::move(folder)), descriptor_(descriptor) {}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : folder_(std::move(other.folder_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  std::error_code ignored;
  fs::remove(lock_file(folder_), ignored);
  close(descriptor_);
}

}  // namespace corridor::runner
