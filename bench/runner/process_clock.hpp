// What a process has used: time since a moment, processor time and peak memory from the kernel.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>

namespace corridor::runner {

double seconds_since(std::chrono::steady_clock::time_point start);

// Processor time of all threads of this process so far [s].
double process_cpu_s();

// Starts the measurement of the peak anew, where the kernel allows it.
void reset_peak_rss();
// Largest resident memory of this process since it started or since the reset [MiB].
std::optional<double> peak_rss_mib();

// Resident memory of another process now [MiB]; nullopt if it is gone.
std::optional<double> resident_mib(pid_t process);

}  // namespace corridor::runner
