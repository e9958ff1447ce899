// All cases of a report, sorted and grouped: by data set, then by series (system, profile,
// back-end). It computes no statistics (tables/summary.hpp).
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/results/machine.hpp"
#include "bench/results/run_result.hpp"
#include "slam/core/result.hpp"

namespace corridor::reports {

struct Case {
  results::RunResult result;
  std::filesystem::path dir;  // runs/<case-id>: trajectories and maps, where the run left any
};

// What is compared: one system with one set of parameters.
struct Series {
  std::string system;
  std::string profile;
  std::string backend;  // empty without one

  auto operator<=>(const Series&) const = default;
};

// What was drawn anew: a simulated world, or for recorded data one seed of the system.
struct World {
  std::string dataset;
  std::optional<std::uint64_t> data_seed;
  std::uint64_t system_seed = 0;  // 0 where data_seed says it all

  auto operator<=>(const World&) const = default;
};

Series series_of(const results::RunResult& result);
World world_of(const results::RunResult& result);

class Cases {
 public:
  // `run_dirs` are named in the page's commands.
  Cases(std::vector<Case> cases, std::vector<results::Machine> machines,
        std::vector<std::filesystem::path> run_dirs);

  // Sorted by data set, series, data seed, system seed, case id.
  [[nodiscard]] const std::vector<Case>& all() const { return cases_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& run_dirs() const { return run_dirs_; }
  [[nodiscard]] const std::vector<results::Machine>& machines() const { return machines_; }
  [[nodiscard]] std::vector<std::string> datasets() const;
  // In the order of reports: the floor, rivals, references, the fusion systems, then other names.
  [[nodiscard]] std::vector<Series> series() const;
  [[nodiscard]] std::vector<const Case*> of(const std::string& dataset) const;
  [[nodiscard]] std::vector<const Case*> of(const std::string& dataset, const Series& series) const;
  // The system's name, with "@profile" and "/backend" only where the cases hold more than one.
  [[nodiscard]] std::string label(const Series& series) const;

 private:
  std::vector<Case> cases_;
  std::vector<results::Machine> machines_;
  std::vector<std::filesystem::path> run_dirs_;
};

// Reads results.sqlite of every directory or, where there is none, every runs/*/result.json. An
// Error for a directory that is missing or holds no result.
Result<Cases> load_cases(const std::vector<std::filesystem::path>& run_dirs);

}  // namespace corridor::reports
