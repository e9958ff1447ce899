// Runs child processes, a few at a time, each with a time and a memory limit, and tells how each
// ended. It knows nothing of cases.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::runner {

struct ChildTask {
  std::vector<std::string> command;   // program, then its arguments
  std::filesystem::path output_file;  // standard output and error
  double time_limit_s = 600;
  std::int64_t memory_limit_mib = 4096;
};

enum class ChildEnd {
  kExited,       // by itself, with exit_code
  kCrashed,      // by a signal that this pool did not send
  kTimeout,      // killed: longer than its limit
  kOutOfMemory,  // killed: more resident memory than its limit, or killed by the kernel for memory
  kNotStarted,   // the program cannot be executed
};

struct ChildResult {
  ChildEnd end = ChildEnd::kNotStarted;
  int exit_code = 0;
  int signal = 0;
  double wall_s = 0;
};

// Calls `finished(index, result)` for each task in the order in which they end; where it answers
// false, nothing more is started and running children are killed. Children die with
// this process. The memory limit is on resident memory, looked at every few hundredths of a second:
// a limit on address space (RLIMIT_AS, RLIMIT_DATA) would count what the libraries reserve and
// never touch, and a failed allocation inside a third-party library could not be told from a crash.
// False: stopped by SIGINT, SIGTERM or `finished`; the rest was not started.
[[nodiscard]] bool run_children(
    const std::vector<ChildTask>& tasks, int num_jobs,
    const std::function<bool(std::size_t, const ChildResult&)>& finished,
    const std::function<void()>& tick);

}  // namespace corridor::runner
