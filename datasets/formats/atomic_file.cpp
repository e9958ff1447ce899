#include "datasets/formats/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace corridor::formats {
namespace {

// A name no other process uses, in the same folder so that the rename cannot cross file systems;
// hidden, and with the suffix of the final name because libraries choose formats by it.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
  return path.parent_path() / fmt::format(".{}.{}.partial{}", path.filename().string(), ::getpid(),
                                          path.extension().string());
}

tl::unexpected<Error> system_failure(const char* what, const std::filesystem::path& path) {
  return fail(ErrorCode::kUnreadable, fmt::format("{}: {}", what, std::strerror(errno)),
              path.string());
}

Result<void> flush_to_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return system_failure("cannot be opened", path);
  const bool is_flushed = ::fsync(descriptor) == 0;
  ::close(descriptor);
  if (!is_flushed) return system_failure("cannot be flushed to the disk", path);
  return {};
}

Result<void> write_plainly(const std::filesystem::path& path, std::string_view content) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return system_failure("cannot be created", path);
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      auto failure = system_failure("cannot be written", path);
      ::close(descriptor);
      return failure;
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(descriptor) != 0) return system_failure("cannot be written", path);
  return {};
}

}  // namespace

Result<void> write_file_atomically(
    const std::filesystem::path& path,
    const std::function<Result<void>(const std::filesystem::path& temporary)>& write) {
  const std::filesystem::path temporary = temporary_name(path);
  auto outcome = write(temporary);
  if (outcome) outcome = flush_to_disk(temporary);
  std::error_code error;
  if (outcome) {
    std::filesystem::rename(temporary, path, error);
    if (error) {
      outcome =
          fail(ErrorCode::kUnreadable, "cannot be replaced: " + error.message(), path.string());
    }
  }
  if (!outcome) {
    std::filesystem::remove(temporary, error);
    // The user knows the final name, not the temporary one.
    Error named = outcome.error();
    if (named.where == temporary.string()) named.where = path.string();
    return tl::make_unexpected(std::move(named));
  }
  return outcome;
}

Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  return write_file_atomically(path, [content](const std::filesystem::path& temporary) {
    return write_plainly(temporary, content);
  });
}

}  // namespace corridor::formats
