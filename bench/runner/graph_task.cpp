#include "bench/runner/graph_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace corridor::runner {
namespace {

// In the order of solve::Initialization, then what is no initialisation of a graph alone.
constexpr std::array<std::string_view, 4> kStarts = {"file", "odometry", "chordal", "optimum"};
constexpr std::string_view kOptimum = kStarts.back();

std::size_t start_index(const GraphBatchParams& params) {
  return static_cast<std::size_t>(std::find(kStarts.begin(), kStarts.end(), params.start) -
                                  kStarts.begin());
}

}  // namespace

std::vector<std::string> GraphBatchParams::relations() const {
  std::vector<std::string> broken;
  if (start_index(*this) == kStarts.size()) {
    broken.push_back(fmt::format("start = {}: expected one of {}", start, fmt::join(kStarts, " ")));
  }
  const bool has_noise = start_position_sigma_m > 0 || start_heading_sigma_rad > 0;
  if (has_noise && start != "file" && start != kOptimum) {
    broken.push_back(
        fmt::format("start = {}: expected file or optimum where noise is put on it", start));
  }
  return broken;
}

GraphTask task_of(const GraphBatchParams& params) {
  GraphTask task;
  task.starts_at_optimum = params.start == kOptimum;
  // The optimum takes the place of the file's poses.
  if (!task.starts_at_optimum) {
    task.options.init = static_cast<solve::Initialization>(start_index(params));
  }
  task.settings.max_iterations = params.max_iterations;
  task.settings.min_relative_decrease = params.min_relative_decrease;
  task.start_position_sigma_m = params.start_position_sigma_m;
  task.start_heading_sigma_rad = params.start_heading_sigma_rad;
  return task;
}

GraphTask task_of(const GraphIncrementalParams& params) {
  GraphTask task;
  task.options.mode = solve::Mode::kIncremental;
  task.options.poses_per_update = params.poses_per_update;
  task.num_checkpoints = params.num_checkpoints;
  return task;
}

}  // namespace corridor::runner
