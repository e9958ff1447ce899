// Files that belong together (a log, its truth, its world): written into a hidden folder first and
// moved into place at the end, so that a failure leaves what lay there before as it was.
// It does not decide what is written; two programs that write the same names do not meet here.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "bench/runner/folder_lock.hpp"
#include "slam/core/result.hpp"

namespace corridor::cli {

// Fails with a clear Error if one of `files` exists and is no regular file, or if the folder of
// one does not exist.
Result<void> check_targets(const std::vector<std::filesystem::path>& files);

class StagedFiles {
 public:
  // The hidden folder lies beside `file`: moving out of it never crosses file systems. Removes
  // those that programs which were ended from outside left there.
  static Result<StagedFiles> beside(const std::filesystem::path& file);
  StagedFiles(StagedFiles&& other) noexcept;
  StagedFiles& operator=(StagedFiles&&) = delete;
  ~StagedFiles();  // removes the hidden folder with all that was not moved out of it

  // Where to write what shall become `target`, a file of the folder that was given.
  [[nodiscard]] std::filesystem::path path_for(const std::filesystem::path& target) const;
  // An Error of writing with the name the user knows instead of the hidden one.
  [[nodiscard]] Error with_final_name(Error error) const;
  // Moves everything that was written into place; if one file cannot be moved, none is.
  Result<void> commit();

 private:
  explicit StagedFiles(std::filesystem::path folder, std::filesystem::path staging)
      : folder_(std::move(folder)), staging_(std::move(staging)) {}
  Result<void> replace(const std::filesystem::path& name);
  void put_back(const std::vector<std::filesystem::path>& names) const;

  std::filesystem::path folder_;
  std::filesystem::path staging_;           // empty: nothing to remove
  std::optional<runner::FolderLock> lock_;  // held as long as the folder is in use
};

}  // namespace corridor::cli
