// All cases of a report, sorted and grouped: by data set, then by series (system, profile,
// back-end, parameters, what of them was set by hand, code revision). It computes no statistics
// (tables/summary.hpp).
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/results/machine.hpp"
#include "bench/results/run_result.hpp"
#include "slam/core/result.hpp"

namespace corridor::reports {

struct Case {
  results::RunResult result;
  std::filesystem::path dir;       // runs/<case-id>: trajectories and maps, where the run left any
  std::string dataset_given = {};  // the data set as the run called it; filled in by Cases
};

// What is compared: one system with one set of parameters, made by one revision of the code.
// Numbers of different parameters or different code are never pooled.
struct Series {
  std::string system;
  std::string profile = {};
  std::string backend = {};  // empty without one
  std::string parameters_hash = {};
  std::string git_revision = {};
  std::string overrides = {};  // "key=value, ..." of what was set by hand; empty for nothing

  auto operator<=>(const Series&) const = default;
};

// What was drawn anew: a simulated world, or for recorded data one seed of the system.
struct World {
  std::string dataset;
  std::optional<std::uint64_t> data_seed;
  std::uint64_t system_seed = 0;  // 0 where data_seed says it all

  auto operator<=>(const World&) const = default;
};

// A pose graph was solved; else a system was run on a log.
bool is_of_graph(const results::RunResult& result);
Series series_of(const results::RunResult& result);
World world_of(const results::RunResult& result);

class Cases {
 public:
  // `run_dirs` are named on the page. Data sets of one name but other content are not one: in the
  // cases' results a part of the content's digest then stands behind the name, "log (#12ab34)".
  Cases(std::vector<Case> cases, std::vector<results::Machine> machines,
        std::vector<std::filesystem::path> run_dirs);

  // Records of one series, data, seeds and number of threads are one experiment: the newest file of
  // them stands, of equally old ones the last given. How many others were set aside.
  [[nodiscard]] std::size_t num_set_aside() const { return num_set_aside_; }
  // Sorted by data set, series, data seed, system seed, case id.
  [[nodiscard]] const std::vector<Case>& all() const { return cases_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& run_dirs() const { return run_dirs_; }
  [[nodiscard]] const std::vector<results::Machine>& machines() const { return machines_; }
  [[nodiscard]] std::vector<std::string> datasets() const;
  // The cases that solved pose graphs, or the others, as a report of their own.
  [[nodiscard]] Cases of_graphs() const { return only(is_of_graph); }
  [[nodiscard]] Cases of_logs() const { return only(std::not_fn(is_of_graph)); }
  // Some of the cases as a report of their own, labels as short as those allow.
  [[nodiscard]] Cases only(const std::function<bool(const results::RunResult&)>& is_wanted) const;
  // In the order of reports: the floor, references, rivals, the fusion systems, then other names;
  // of one system first what it ships with.
  [[nodiscard]] std::vector<Series> series() const;
  [[nodiscard]] std::vector<const Case*> of(const std::string& dataset) const;
  [[nodiscard]] std::vector<const Case*> of(const std::string& dataset, const Series& series) const;
  // The name for people (series_labels.hpp); requires a series of the cases.
  [[nodiscard]] const std::string& label(const Series& series) const { return labels_.at(series); }

 private:
  std::vector<Case> cases_;
  std::vector<results::Machine> machines_;
  std::vector<std::filesystem::path> run_dirs_;
  std::map<Series, std::string> labels_;
  std::size_t num_set_aside_ = 0;
};

// Reads results.sqlite of every directory or, where there is none, every runs/*/result.json. An
// Error for a directory that is missing or holds no result.
Result<Cases> load_cases(const std::vector<std::filesystem::path>& run_dirs);

}  // namespace corridor::reports
