#include "reports/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace corridor::reports {
namespace {

// Records of older revisions have no such field, and a number below one means nothing.
template <class Record>
std::optional<std::int64_t> jobs_field(const Record& record) {
  if constexpr (requires { record.jobs; }) {
    const std::optional<std::int64_t> jobs = record.jobs;
    return jobs && *jobs > 0 ? jobs : std::nullopt;
  } else {
    return std::nullopt;
  }
}

std::string jobs_note(const Cases& cases) {
  const std::size_t num_cases = cases.all().size();
  std::size_t num_unknown = 0;
  std::size_t num_beside_others = 0;
  std::int64_t most = 1;
  for (const Case& entry : cases.all()) {
    const auto jobs = jobs_of(entry.result);
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

std::optional<std::int64_t> jobs_of(const results::RunResult& result) { return jobs_field(result); }

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
    notes.push_back("Warning: the cases were given different numbers of threads.");
  }
  return notes;
}

}  // namespace corridor::reports
