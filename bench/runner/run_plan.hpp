// Runs the cases of a plan, one process each, and gathers what they leave in the results store.
// A case that crashes, takes too long or too much memory, or has bad input is a row like any other.
#pragma once

#include <filesystem>
#include <optional>

#include "bench/runner/folder_lock.hpp"
#include "bench/runner/plan.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct RunOptions {
  std::filesystem::path executable;  // started as: executable run-case SPEC.json --out OUT
  std::optional<std::filesystem::path> data_dir;  // handed on to the cases
  int num_jobs = 1;
  bool is_resumed = false;  // keep finished cases whose spec and build of the program are the same
  bool is_quiet = false;
  bool is_terminal = false;
};

struct RunSummary {
  std::size_t num_cases = 0;
  std::size_t num_kept = 0;     // finished in an earlier run
  std::size_t num_failed = 0;   // failed, timeout, out_of_memory, bad_input
  std::size_t num_earlier = 0;  // of other runs into the same folder, which stay there
  bool is_interrupted = false;
};

// The results go to the folder that is locked. An Error if they cannot be written.
Result<RunSummary> run_plan(const Plan& plan, const FolderLock& out, const RunOptions& options);

}  // namespace corridor::runner
