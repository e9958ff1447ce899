// A suite: which systems run on which data with which seeds, as a TOML file under bench/suites/.
// It does not look for data and does not run anything.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/runner/case_spec.hpp"
#include "bench/runner/systems.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct Suite {
  std::string name;
  std::string description;
  std::vector<SystemChoice> systems;
  std::vector<std::string> backends;  // empty: each system's own
  // Other ones for some of the systems: what solves at once need not be fed pose by pose.
  std::vector<std::pair<SystemChoice, std::vector<std::string>>> backends_of;
  std::vector<std::string> scenarios;  // names or paths
  std::vector<std::string> datasets;   // catalogue names or paths
  // Scenarios are drawn with seeds first_seed, first_seed + 1, ...; recorded data are run with as
  // many seeds of the systems that draw random numbers, and once with the others.
  std::uint64_t first_seed = 1;
  int num_seeds = 1;
  int threads = 1;
  CaseLimits limits;
  std::map<std::string, ParamValues> overrides;  // by system or back-end

  // Empty: the system's own.
  [[nodiscard]] const std::vector<std::string>& backends_for(const SystemChoice& choice) const;
};

// Keys: name description systems backends scenarios datasets first_seed num_seeds threads,
// [limits] time_s memory_mib, [overrides.NAME] parameter = value, NAME a system or back-end,
// [backends_of] "SYSTEM" or "SYSTEM@PROFILE" = [names]. The Error lists ALL unknown keys, wrong
// types, unknown names and broken rules, each as file:line.
Result<Suite> read_suite(const std::filesystem::path& path);

// bench/suites/ of the source tree; $CORRIDOR_BENCH_SUITES overrides.
std::filesystem::path suites_folder();
// The suite files, sorted by name.
std::vector<std::filesystem::path> list_suites();
// A suite's file by its name, or the path itself if it names a .toml file.
Result<std::filesystem::path> find_suite(const std::string& name_or_path);

// The back-ends that cases of the suite have, each once.
std::vector<std::string> back_ends_of(const Suite& suite);
// Overrides of a system or back-end, checked against its parameters; those of a system that is not
// run only by name.
Result<void> check_overrides(const Suite& suite, const std::string& owner,
                             const ParamValues& params);
// What a case with that system and back-end has set by hand; see split_overrides().
ParamValues overrides_of_case(const Suite& suite, const std::string& system,
                              const std::optional<std::string>& back_end);
// Adds overrides "NAME.key=value", checked as above.
Result<void> add_overrides(Suite& suite, const std::vector<std::string>& texts);

}  // namespace corridor::runner
