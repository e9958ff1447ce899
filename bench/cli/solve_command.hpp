// corridor-bench solve: one pose graph with one back-end, at once or pose by pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct SolveCommand {
  CommonOptions common;
  std::string graph;
  std::string back_end;
  std::string mode = "batch";
  std::string robust = "none";
  // Empty: not asked for.
  std::optional<std::string> linear;
  std::optional<std::string> init;
  std::optional<double> width;
  std::optional<int> every;
  std::optional<int> lag;
  std::vector<std::string> overrides;
  bool do_converge = false;
  std::optional<double> inlier_probability;
  std::optional<double> false_closures;
  std::optional<std::string> false_pairs;
  std::optional<std::string> seed;
  std::string rejected;
  std::string out;
  std::string tree;
  bool is_json = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run(const TreeDrawer& draw_tree) const;
};

}  // namespace corridor::cli
