// A run directory as corridor-bench leaves it, made of invented but consistent cases: an L-shaped
// path, estimates that shrink along the first arm by a known factor, and maps drawn from the shrunk
// walls.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/results/run_result.hpp"
#include "reports/cases.hpp"

namespace corridor::reports::testing {

struct SyntheticSystem {
  std::string name;
  double shrink_ratio = 0;     // of the first arm: 0.1 = a tenth too short
  double spread_ratio = 0.05;  // how much the shrinking differs between worlds
};

struct SyntheticRun {
  std::string suite = "synthetic";
  std::string dataset = "synthetic-corridor";
  std::vector<SyntheticSystem> systems;
  int num_worlds = 8;
  bool has_files = true;  // trajectories, maps and walls beside the records
};

// The four systems of the paper's tables and dead reckoning; fusion is the most accurate in every
// world.
SyntheticRun paper_like_run();

// The record of one system in one world, without files.
results::RunResult synthetic_result(const SyntheticRun& run, const SyntheticSystem& system,
                                    std::uint64_t data_seed);

// A run of these systems, the rest as by default.
SyntheticRun run_of(std::vector<SyntheticSystem> systems);

// The records of every system in worlds 1 to num_worlds, system by system.
std::vector<results::RunResult> synthetic_results(const SyntheticRun& run,
                                                  std::uint64_t num_worlds = 8);

// Records without files, as a report reads them.
Cases make_cases(const std::vector<results::RunResult>& results);

// Writes `run_dir`/results.sqlite with all cases and `extra`, and runs/<case-id>/ with their files.
void write_synthetic_run(const SyntheticRun& run, const std::filesystem::path& run_dir,
                         const std::vector<results::RunResult>& extra = {});

}  // namespace corridor::reports::testing
