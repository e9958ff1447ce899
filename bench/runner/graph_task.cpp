#include "bench/runner/graph_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "bench/solve/robust_method.hpp"
#include "slam/core/enum_text.hpp"

namespace corridor::runner {
namespace {

// No initialisation of a graph alone.
constexpr std::string_view kOptimum = "optimum";

// A name is not among those known: the line that says so.
void check_name(std::string_view parameter, const std::string& value,
                const std::vector<std::string>& known, std::vector<std::string>& broken) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return;
  broken.push_back(
      fmt::format("{} = {}: expected one of {}", parameter, value, fmt::join(known, " ")));
}

}  // namespace

std::vector<std::string> GraphBatchParams::relations() const {
  std::vector<std::string> broken;
  std::vector<std::string> starts = texts_of(solve::kInitializations);
  starts.emplace_back(kOptimum);
  check_name("start", start, starts, broken);
  check_name("false_pairs", false_pairs, texts_of(solve::kFalsePairs), broken);
  check_name("robust", robust, solve::robust_methods(), broken);
  const bool has_noise = start_position_sigma_m > 0 || start_heading_sigma_rad > 0;
  if (has_noise && start != "file" && start != kOptimum) {
    broken.push_back(
        fmt::format("start = {}: expected file or optimum where noise is put on it", start));
  }
  return broken;
}

std::vector<std::string> GraphIncrementalParams::relations() const {
  if (!use_calls || poses_per_update == 1) return {};
  return {
      fmt::format("poses_per_update = {}: expected 1 where use_calls is true", poses_per_update)};
}

GraphTask task_of(const GraphBatchParams& params) {
  GraphTask task;
  task.starts_at_optimum = params.start == kOptimum;
  // The optimum takes the place of the file's poses.
  if (!task.starts_at_optimum) {
    task.options.init = *from_text(solve::kInitializations, params.start);
  }
  task.settings.max_iterations = params.max_iterations;
  task.settings.min_relative_decrease = params.min_relative_decrease;
  solve::set_robust_method(params.robust, params.kernel_width, task.options);
  task.options.inlier_probability = params.inlier_probability;
  task.false_closures = params.false_closures;
  task.false_pairs = *from_text(solve::kFalsePairs, params.false_pairs);
  task.start_position_sigma_m = params.start_position_sigma_m;
  task.start_heading_sigma_rad = params.start_heading_sigma_rad;
  return task;
}

GraphTask task_of(const GraphIncrementalParams& params) {
  GraphTask task;
  task.options.mode = solve::Mode::kIncremental;
  // Of what a recording solves at once; as far as the other back-ends go.
  task.settings.max_iterations = solve::kMaxBatchIterations;
  task.settings.min_relative_decrease = solve::kMinBatchRelativeDecrease;
  task.options.poses_per_update = params.poses_per_update;
  task.num_checkpoints = params.num_checkpoints;
  task.use_calls = params.use_calls;
  return task;
}

std::optional<std::string> why_unfit(const GraphTask& task, bool is_of_system) {
  const bool is_batch = task.options.mode == solve::Mode::kBatch;
  if (!is_of_system) {
    return task.use_calls ? std::optional("replays a system's calls, and this is a pose graph")
                          : std::nullopt;
  }
  if (!is_batch && !task.use_calls) {
    return "goes pose by pose, and this graph has calls: see profile calls";
  }
  if (task.false_closures > 0 || task.options.rejection != solve::Rejection::kNone ||
      task.options.kernel.kind != graph::KernelKind::kNone) {
    return "treats closures as such, and this graph has none that are told apart";
  }
  if (task.starts_at_optimum || task.has_start_noise() ||
      task.options.init != solve::Initialization::kFile) {
    return "starts elsewhere, and this graph has the values that its system gave";
  }
  return std::nullopt;
}

std::optional<std::string> why_unfit(const GraphTask& task, const BackEndInfo& back_end) {
  if (task.options.mode != solve::Mode::kBatch || !back_end.forgets) return std::nullopt;
  return fmt::format("asks for all poses at once, and {} forgets old ones", back_end.name);
}

}  // namespace corridor::runner
