#include "bench/results/machine.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>

#include "bench/results/digest.hpp"

namespace corridor::results {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (line.starts_with("model name") && colon != std::string::npos && colon + 2 < line.size()) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::int64_t memory_mib() {
  const long num_pages = sysconf(_SC_PHYS_PAGES);
  const long page_bytes = sysconf(_SC_PAGESIZE);
  if (num_pages <= 0 || page_bytes <= 0) return 0;
  return static_cast<std::int64_t>(num_pages) * page_bytes / (1024 * 1024);
}

std::string kernel() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu_model = cpu_model();
  machine.num_cores = sysconf(_SC_NPROCESSORS_ONLN);
  machine.memory_mib = memory_mib();
  machine.kernel = kernel();
  machine.compiler = CORRIDOR_COMPILER;
  machine.machine_id =
      short_digest(fmt::format("{}\n{}\n{}\n{}\n{}", machine.cpu_model, machine.num_cores,
                               machine.memory_mib, machine.kernel, machine.compiler));
  return machine;
}

}  // namespace corridor::results
