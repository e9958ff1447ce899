// What a process has used: time since a moment, processor time and peak memory from the kernel.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>

namespace corridor::runner {

double seconds_since(std::chrono::steady_clock::time_point start);

// Wall and processor time of this process, while it runs.
class Stopwatch {
 public:
  void start();  // requires that it does not run
  void stop();   // requires that it runs
  [[nodiscard]] double wall_s() const { return wall_s_; }
  [[nodiscard]] double cpu_s() const { return cpu_s_; }

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_at_start_s_ = 0;
  double wall_s_ = 0, cpu_s_ = 0;
};

// The largest resident memory of this process from the making on, where the kernel allows it to be
// measured.
class MemoryWatch {
 public:
  // Gives memory that is free back to the kernel first, so that all that is taken counts.
  MemoryWatch();
  [[nodiscard]] std::optional<double> peak_mib() const;
  // Of the peak, beyond what there was, without the pages of programs and libraries that came in.
  [[nodiscard]] std::optional<double> growth_mib() const;

 private:
  // Nothing where the kernel did not start its measurement anew.
  std::optional<double> at_start_mib_, files_at_start_mib_;
};

// Resident memory of another process now [MiB]; nullopt if it is gone.
std::optional<double> resident_mib(pid_t process);

}  // namespace corridor::runner
