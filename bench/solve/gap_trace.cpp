#include "bench/solve/gap_trace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bench/solve/optimum.hpp"

namespace corridor::solve {
namespace {

// Update k is one if on the way from k to k + 1 of num_updates a multiple of
// num_updates / num_checkpoints is passed.
bool is_checkpoint(std::size_t update_index, std::size_t num_updates, std::size_t num_checkpoints) {
  return (update_index + 1) * num_checkpoints / num_updates !=
         update_index * num_checkpoints / num_updates;
}

// The optimum of fewer variables, and those that came since as the estimate has them: poses
// relative to the pose that was the newest then.
graph::Values extended(const graph::Values& optimum, std::uint32_t newest_then,
                       const graph::Values& estimate) {
  const Pose2 T_optimum_estimate = optimum.pose(newest_then) * estimate.pose(newest_then).inverse();
  graph::Values values = optimum;
  for (const graph::Key key : estimate.keys()) {
    if (values.contains(key)) continue;
    if (key.kind == graph::VariableKind::kPose) {
      values.set_pose(key.index, T_optimum_estimate * estimate.pose(key.index));
    } else {
      values.copy(key, estimate);
    }
  }
  return values;
}

class Tracer {
 public:
  Tracer(std::size_t num_updates, std::size_t num_checkpoints, Measure measure)
      : num_updates_(num_updates),
        num_checkpoints_(std::min(num_updates, num_checkpoints)),
        measure_(measure) {}

  void take(const Moment& moment) {
    const std::size_t index = num_seen_++;
    if (!is_checkpoint(index, num_updates_, num_checkpoints_)) return;
    const graph::Values estimate = moment.estimate();
    const double chi2 = chi2_of(moment.told, estimate, measure_);
    if (!std::isfinite(chi2)) return;
    std::vector<graph::Values> starts = {estimate};
    if (optimum_) starts.push_back(extended(optimum_->values, newest_, estimate));
    optimum_ = optimum_near(moment.told, starts, measure_);
    newest_ = moment.update.newest;
    const Pose2 T_estimate_optimum = estimate.pose(newest_).between(optimum_->values.pose(newest_));
    checkpoints_.push_back({index, chi2, optimum_->chi2, T_estimate_optimum.translation_m().norm(),
                            std::abs(T_estimate_optimum.theta_rad())});
  }

  [[nodiscard]] std::vector<Checkpoint> checkpoints() && { return std::move(checkpoints_); }

 private:
  std::size_t num_updates_, num_checkpoints_;
  Measure measure_;
  std::size_t num_seen_ = 0;
  std::optional<Optimum> optimum_;  // of the last checkpoint
  std::uint32_t newest_ = 0;
  std::vector<Checkpoint> checkpoints_;
};

template <class Graph>
Result<std::vector<Checkpoint>> trace(const Graph& graph, backend::BackEnd& back_end,
                                      const SolveOptions& options, Tracer tracer) {
  SolveOptions replay = options;
  replay.after_update = [&](const Moment& moment) { tracer.take(moment); };
  const Result<SolveRun> done = solve_graph(graph, back_end, replay);
  if (!done) return tl::make_unexpected(done.error());
  return std::move(tracer).checkpoints();
}

}  // namespace

Result<std::vector<Checkpoint>> trace_gap(const formats::PoseGraph& graph,
                                          backend::BackEnd& back_end, const SolveOptions& options,
                                          std::size_t num_updates, std::size_t num_checkpoints) {
  return trace(graph, back_end, options, Tracer(num_updates, num_checkpoints, Measure::kEdges));
}

Result<std::vector<Checkpoint>> trace_gap(const Recording& recording, backend::BackEnd& back_end,
                                          const SolveOptions& options, std::size_t num_updates,
                                          std::size_t num_checkpoints) {
  return trace(recording, back_end, options, Tracer(num_updates, num_checkpoints, Measure::kCost));
}

}  // namespace corridor::solve
