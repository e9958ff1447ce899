#include "bench/cli/staged_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "bench/cli/command.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// Of the staging folder: what lay in the way, until every file is in place.
constexpr const char* kPrevious = "previous";

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
  const fs::path staging =
      folder / fmt::format(".{}.{}.partial", file.filename().string(), ::getpid());
  std::error_code error;
  const bool is_new = fs::create_directory(staging, error);
  if (error) return cannot("cannot be written", file, error);
  if (!is_new) {
    return fail(ErrorCode::kInvalid, "the folder is left from another program", staging.string(),
                "a name that is free");
  }
  StagedFiles staged(folder, staging);
  fs::create_directory(staging / kPrevious, error);
  if (error) return cannot("cannot be written", file, error);
  return staged;
}

StagedFiles::StagedFiles(StagedFiles&& other) noexcept
    : folder_(std::move(other.folder_)), staging_(std::exchange(other.staging_, {})) {}

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
