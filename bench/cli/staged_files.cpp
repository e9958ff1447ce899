#include "bench/cli/staged_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <string>
#include <system_error>

#include "bench/cli/command.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// Of the staging folder: what lay in the way, until every file is in place.
constexpr const char* kPrevious = "previous";

constexpr const char* kPartial = ".partial";

// The process in ".NAME.PROCESS.partial"; nullopt for any other name.
std::optional<pid_t> owner_of(const fs::path& staging) {
  const std::string name = staging.filename().string();
  const std::string process = fs::path(name).stem().extension().string();
  if (name.front() != '.' || staging.extension() != kPartial || process.size() < 2) {
    return std::nullopt;
  }
  pid_t found = 0;
  const char* const end = process.data() + process.size();
  const auto [rest, error] = std::from_chars(process.data() + 1, end, found);
  if (error != std::errc() || rest != end || found <= 0) return std::nullopt;
  return found;
}

// Left behind by a program that was ended: there is no such process here, and none elsewhere on a
// shared disk, or it would hold the lock.
void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  const fs::path where = folder.empty() ? fs::path(".") : folder;
  for (fs::directory_iterator entry(where, ignored), end; entry != end; entry.increment(ignored)) {
    const fs::path& staging = entry->path();
    const std::optional<pid_t> owner = owner_of(staging);
    const bool is_ended = owner && ::kill(*owner, 0) != 0 && errno == ESRCH;
    if (!is_ended || !fs::is_directory(fs::symlink_status(staging, ignored))) continue;
    const fs::path previous = staging / kPrevious;
    // What was in the way of new files and could not be put back is the user's.
    const bool holds_users_files =
        fs::is_directory(previous, ignored) &&
        std::any_of(fs::directory_iterator(previous, ignored), fs::directory_iterator(),
                    [](const auto& file) { return file.path().filename() != ".lock"; });
    if (holds_users_files) continue;
    if (const auto lock = runner::FolderLock::take(previous); !lock) continue;
    fs::remove_all(staging, ignored);
  }
}

tl::unexpected<Error> cannot(const char* what, const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::kUnreadable, fmt::format("{}: {}", what, error.message()), path.string());
}

}  // namespace

Result<void> check_targets(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (const Result<void> folder = check_parent_folder(file); !folder) return folder;
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      return fail(ErrorCode::kInvalid, "this is no regular file and is not replaced", file.string(),
                  "a new name or a file");
    }
  }
  return {};
}

Result<StagedFiles> StagedFiles::beside(const fs::path& file) {
  const fs::path folder = file.parent_path();
  remove_leftovers(folder);
  const fs::path staging =
      folder / fmt::format(".{}.{}{}", file.filename().string(), ::getpid(), kPartial);
  std::error_code error;
  const bool is_new = fs::create_directory(staging, error);
  if (error) return cannot("cannot be written", file, error);
  if (!is_new) {
    return fail(ErrorCode::kInvalid, "the folder is left from another program", staging.string(),
                "a name that is free");
  }
  StagedFiles staged(folder, staging);
  auto lock = runner::FolderLock::take(staging / kPrevious);
  if (!lock) return tl::make_unexpected(lock.error());
  staged.lock_.emplace(std::move(*lock));
  return staged;
}

StagedFiles::StagedFiles(StagedFiles&& other) noexcept
    : folder_(std::move(other.folder_)),
      staging_(std::exchange(other.staging_, {})),
      lock_(std::move(other.lock_)) {}

StagedFiles::~StagedFiles() {
  if (staging_.empty()) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

fs::path StagedFiles::path_for(const fs::path& target) const {
  return staging_ / target.filename();
}

Error StagedFiles::with_final_name(Error error) const {
  const fs::path where(error.where);
  if (where.parent_path() == staging_) error.where = (folder_ / where.filename()).string();
  return error;
}

Result<void> StagedFiles::commit() {
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(staging_)) {
    if (!entry.is_directory()) names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  std::vector<fs::path> moved;
  for (const fs::path& name : names) {
    moved.push_back(name);
    const Result<void> replaced = replace(name);
    if (replaced) continue;
    put_back(moved);
    return replaced;
  }
  return {};
}

Result<void> StagedFiles::replace(const fs::path& name) {
  const fs::path target = folder_ / name;
  if (const Result<void> good = check_targets({target}); !good) return good;
  std::error_code error;
  if (fs::exists(fs::symlink_status(target))) {
    fs::rename(target, staging_ / kPrevious / name, error);
    if (error) return cannot("cannot be replaced", target, error);
  }
  fs::rename(staging_ / name, target, error);
  if (error) return cannot("cannot be written", target, error);
  return {};
}

void StagedFiles::put_back(const std::vector<fs::path>& names) const {
  std::error_code ignored;
  for (const fs::path& name : names) {
    // Still staged: the new file is not what lies at the target.
    const bool is_in_place = !fs::exists(staging_ / name, ignored);
    if (is_in_place) fs::remove(folder_ / name, ignored);
    const fs::path previous = staging_ / kPrevious / name;
    if (fs::exists(fs::symlink_status(previous, ignored))) {
      fs::rename(previous, folder_ / name, ignored);
    }
  }
}

}  // namespace corridor::cli
