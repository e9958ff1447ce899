// The results store, results.sqlite: one row per case with a column per scalar key of the result
// record and the whole record as JSON; one row per machine. Every change is one transaction.
// It keeps no trajectory and no map: those lie in runs/<case-id>/.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "bench/results/machine.hpp"
#include "bench/results/run_result.hpp"
#include "slam/core/result.hpp"

namespace corridor::results {

class ResultsStore {
 public:
  // Opens; creates the file and its tables where they are missing. Columns that a newer revision
  // added are added to an older file. A file that is not a store of ours is an Error.
  static Result<ResultsStore> open(const std::filesystem::path& path);
  // As it stands on the disk, for reports: an Error if it is not there; nothing is created.
  static Result<ResultsStore> open_read_only(const std::filesystem::path& path);

  ResultsStore(ResultsStore&&) noexcept;
  ResultsStore& operator=(ResultsStore&&) noexcept;
  ~ResultsStore();

  // Replaces the row of the same case_id. All rows or, on an Error, none.
  Result<void> put(const std::vector<RunResult>& results);
  Result<void> put(const Machine& machine);

  // In the order of their case_id.
  [[nodiscard]] Result<std::vector<RunResult>> read_all() const;
  [[nodiscard]] Result<std::vector<Machine>> read_machines() const;

 private:
  struct Connection;
  explicit ResultsStore(std::unique_ptr<Connection> connection);

  std::unique_ptr<Connection> connection_;
};

}  // namespace corridor::results
