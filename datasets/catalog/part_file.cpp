#include "datasets/catalog/part_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace corridor::catalog {
namespace {

constexpr mode_t kReadableByAll = 0666;  // less the user's mask

tl::unexpected<Error> system_failure(const char* what, const std::filesystem::path& path) {
  return fail(ErrorCode::kUnreadable, fmt::format("{}: {}", what, std::strerror(errno)),
              path.string());
}

}  // namespace

Result<PartFile> PartFile::open(std::filesystem::path path) {
  const int descriptor =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, kReadableByAll);
  if (descriptor < 0) return system_failure("cannot be created", path);
  PartFile part(std::move(path), descriptor, 0);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return fail(ErrorCode::kUnreadable, "another program is fetching this file",
                part.path_.string(), "its end");
  }
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    return fail(ErrorCode::kUnreadable, "is not a file", part.path_.string(), "a regular file");
  }
  part.size_bytes_ = static_cast<std::uint64_t>(status.st_size);
  return part;
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

PartFile::PartFile(PartFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_bytes_(other.size_bytes_) {}

tl::unexpected<Error> PartFile::failure(const char* what) const {
  return system_failure(what, path_);
}

Result<void> PartFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return failure("cannot be written");
    size_bytes_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> PartFile::clear() {
  if (::ftruncate(descriptor_, 0) != 0) return failure("cannot be written");
  size_bytes_ = 0;
  return {};
}

Result<void> PartFile::rename_to(const std::filesystem::path& target) {
  if (::fsync(descriptor_) != 0) return failure("cannot be flushed to the disk");
  if (::rename(path_.c_str(), target.c_str()) != 0) {
    return system_failure("cannot be replaced", target);
  }
  return {};
}

void PartFile::remove() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace corridor::catalog
