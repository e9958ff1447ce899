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

// The optimum of fewer poses, and the poses that came since where the estimate has them relative to
// the pose that was the newest then.
graph::Values extended(const graph::Values& optimum, std::uint32_t newest_then,
                       const graph::Values& estimate) {
  const Pose2 T_optimum_estimate = optimum.pose(newest_then) * estimate.pose(newest_then).inverse();
  graph::Values values = optimum;
  for (const graph::Key key : estimate.keys()) {
    if (!values.contains(key)) {
      values.set_pose(key.index, T_optimum_estimate * estimate.pose(key.index));
    }
  }
  return values;
}

class Tracer {
 public:
  Tracer(std::size_t num_updates, std::size_t num_checkpoints)
      : num_updates_(num_updates), num_checkpoints_(num_checkpoints) {}

  void take(const backend::BackEnd& back_end, const Update& update) {
    const std::size_t index = num_seen_++;
    if (!is_checkpoint(index, num_updates_, num_checkpoints_)) return;
    const graph::Values& estimate = back_end.estimate();
    const double chi2 = edges_chi2(back_end.graph(), estimate);
    if (!std::isfinite(chi2)) return;
    std::vector<graph::Values> starts = {estimate};
    if (optimum_) starts.push_back(extended(optimum_->values, newest_, estimate));
    optimum_ = optimum_near(back_end.graph(), starts);
    newest_ = update.newest;
    const Pose2 T_estimate_optimum = estimate.pose(newest_).between(optimum_->values.pose(newest_));
    checkpoints_.push_back({index, chi2, optimum_->chi2, T_estimate_optimum.translation_m().norm(),
                            std::abs(T_estimate_optimum.theta_rad())});
  }

  [[nodiscard]] std::vector<Checkpoint> checkpoints() && { return std::move(checkpoints_); }

 private:
  std::size_t num_updates_, num_checkpoints_;
  std::size_t num_seen_ = 0;
  std::optional<Optimum> optimum_;  // of the last checkpoint
  std::uint32_t newest_ = 0;
  std::vector<Checkpoint> checkpoints_;
};

}  // namespace

Result<std::vector<Checkpoint>> trace_gap(const formats::PoseGraph& graph,
                                          backend::BackEnd& back_end, const SolveOptions& options,
                                          std::size_t num_updates, std::size_t num_checkpoints) {
  Tracer tracer(num_updates, std::min(num_updates, num_checkpoints));
  SolveOptions replay = options;
  replay.after_update = [&](const backend::BackEnd& solver, const Update& update) {
    tracer.take(solver, update);
  };
  const Result<SolveRun> done = solve_graph(graph, back_end, replay);
  if (!done) return tl::make_unexpected(done.error());
  return std::move(tracer).checkpoints();
}

}  // namespace corridor::solve
