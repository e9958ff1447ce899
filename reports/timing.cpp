#include "reports/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace corridor::reports {
namespace {

std::string jobs_note(const Cases& cases) {
  const std::size_t num_cases = cases.all().size();
  std::size_t num_unknown = 0;
  std::size_t num_beside_others = 0;
  int most = 1;
  for (const Case& entry : cases.all()) {
    const std::optional<int> jobs = entry.result.jobs;
    num_unknown += jobs ? 0 : 1;
    num_beside_others += jobs && *jobs > 1 ? 1 : 0;
    most = std::max(most, jobs.value_or(1));
  }
  if (num_beside_others > 0) {
    return fmt::format(
        "Warning: {} of {} cases ran beside others, up to {} at a time, and shared cores, caches "
        "and "
        "memory with them. These times are not to be quoted; run with --jobs 1 for times.",
        num_beside_others, num_cases, most);
  }
  if (num_unknown > 0) {
    return fmt::format(
        "How many cases ran at a time was not recorded for {} of {} cases: their times hold only "
        "if "
        "it was one.",
        num_unknown, num_cases);
  }
  return "Cases ran one at a time.";
}

}  // namespace

std::vector<std::string> timing_notes(const Cases& cases) {
  std::vector<std::string> notes = {jobs_note(cases)};
  std::set<std::string> machines;
  std::set<int> threads;
  for (const Case& entry : cases.all()) {
    machines.insert(entry.result.machine_id);
    threads.insert(entry.result.threads);
  }
  if (machines.size() > 1) {
    notes.push_back(fmt::format(
        "Warning: cases of {} machines stand together here; times of different machines "
        "are not comparable.",
        machines.size()));
  }
  if (threads.size() > 1) {
    notes.emplace_back("Warning: the cases were given different numbers of threads.");
  }
  return notes;
}

}  // namespace corridor::reports
