#include "bench/runner/process_clock.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

namespace corridor::runner {
namespace {

constexpr double kKibPerMib = 1024.0;
constexpr double kBytesPerMib = 1024.0 * 1024.0;

// Of all threads so far.
double process_cpu_s() {
  constexpr double kNanoseconds = 1e-9;
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + kNanoseconds * static_cast<double>(now.tv_nsec);
}

// A line of /proc/self/status.
std::optional<double> status_mib(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double size_kib = 0;
    if (word == key && status >> size_kib) return size_kib / kKibPerMib;
    status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

}  // namespace

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Stopwatch::start() {
  start_ = std::chrono::steady_clock::now();
  cpu_at_start_s_ = process_cpu_s();
}

void Stopwatch::stop() {
  wall_s_ += seconds_since(start_);
  cpu_s_ += process_cpu_s() - cpu_at_start_s_;
}

MemoryWatch::MemoryWatch() {
  malloc_trim(0);
  // proc(5): writing 5 sets VmHWM to the present size.
  std::ofstream reset("/proc/self/clear_refs");
  reset << "5" << std::flush;
  if (!reset) return;
  at_start_mib_ = resident_mib(getpid());
  files_at_start_mib_ = status_mib("RssFile:");
}

std::optional<double> MemoryWatch::growth_mib() const {
  const std::optional<double> peak = peak_mib();
  const std::optional<double> files = status_mib("RssFile:");
  if (!peak || !files || !at_start_mib_ || !files_at_start_mib_) return std::nullopt;
  return std::max(*peak - *at_start_mib_ - std::max(*files - *files_at_start_mib_, 0.0), 0.0);
}

// VmHWM belongs to the address space. getrusage()'s ru_maxrss would not do: it survives exec() and
// shows the parent's size of the moment of the fork.
std::optional<double> MemoryWatch::peak_mib() const { return status_mib("VmHWM:"); }

std::optional<double> resident_mib(pid_t process) {
  std::ifstream statm(fmt::format("/proc/{}/statm", process));
  double num_pages_virtual = 0;
  double num_pages_resident = 0;
  if (!(statm >> num_pages_virtual >> num_pages_resident)) return std::nullopt;
  return num_pages_resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kBytesPerMib;
}

}  // namespace corridor::runner
