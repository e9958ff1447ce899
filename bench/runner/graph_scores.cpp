#include "bench/runner/graph_scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "bench/metrics/score_case.hpp"
#include "bench/runner/cost.hpp"
#include "bench/solve/false_closures.hpp"
#include "bench/statistics/quantiles.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::runner {
namespace {

using backend::SolveStatus;
using results::CaseStatus;
using results::RunResult;

constexpr double kMicroseconds = 1e6;

// A solution whose chi2 is more than twice the best has settled elsewhere, unless both fit every
// measurement to a tenth of its standard deviation: chi2 per degree of freedom of a hundredth.
constexpr double kLostChi2Ratio = 2;
constexpr double kMinLostChi2PerDof = 0.01;

// A graph has no clock: a second per pose.
Trajectory trajectory_of(const Poses& poses) {
  Trajectory trajectory;
  for (const formats::PoseGraph::Vertex& pose : poses) {
    static_cast<void>(
        trajectory.append({timestamp_from_seconds(pose.id), pose.T_map_base, std::nullopt}));
  }
  return trajectory;
}

std::optional<std::string> why_lost(const GraphSize& size, const RunResult& result) {
  if (!result.chi2 || !std::isfinite(*result.chi2)) return "chi2 is not finite";
  const double excess = *result.chi2 - *result.chi2_best;
  const auto dof = static_cast<double>(size.num_degrees_of_freedom);
  if (*result.chi2 <= kLostChi2Ratio * *result.chi2_best || excess <= kMinLostChi2PerDof * dof) {
    return std::nullopt;
  }
  return fmt::format("lost: chi2 {:.6g}, the best known is {:.6g}", *result.chi2,
                     *result.chi2_best);
}

}  // namespace

GraphSize size_of(const formats::PoseGraph& graph) {
  GraphSize size;
  size.num_factors = static_cast<std::int64_t>(graph.edges.size());
  size.num_variables = size.num_poses = static_cast<std::int64_t>(graph.vertices.size());
  constexpr int kScalars = 3;  // of a pose, and of an edge
  size.num_degrees_of_freedom =
      kScalars * std::max<std::int64_t>(size.num_factors - size.num_variables + 1, 1);
  return size;
}

GraphSize size_of(const solve::Recording& recording) {
  const graph::FactorGraph factors = recording.factors();
  GraphSize size;
  std::int64_t num_measured = 0, num_solved_for = 0;
  factors.for_each([&]<class F>(graph::FactorId, const F& factor, const graph::RobustKernel&) {
    if constexpr (graph::kIsFixed<F>) {
      num_measured += F::kRows;
    } else {
      num_measured += factor.num_rows();
    }
  });
  for (const graph::Key key : recording.initial_values().keys()) {
    num_solved_for += key.dimension();
    ++size.num_variables;
    if (key.kind == graph::VariableKind::kPose) ++size.num_poses;
  }
  size.num_factors = static_cast<std::int64_t>(factors.num_factors());
  size.num_degrees_of_freedom = std::max<std::int64_t>(num_measured - num_solved_for, 1);
  return size;
}

void score_poses(const GraphSize& size, const Poses& truth, const Poses& final, const Poses& online,
                 RunResult& result) {
  if (truth.empty()) {
    result.poses_expected = size.num_poses;
    result.poses_matched = static_cast<std::int64_t>(final.size());
    return;
  }
  const Trajectory true_trajectory = trajectory_of(truth);
  const Trajectory final_trajectory = trajectory_of(final);
  const Trajectory online_trajectory = trajectory_of(online);
  metrics::CaseEvidence evidence;
  if (!final.empty()) evidence.final_trajectory = &final_trajectory;
  if (!online.empty()) evidence.online_trajectory = &online_trajectory;
  evidence.truth_world = &true_trajectory;
  result.true_poses = "truth";
  const std::vector<std::string> notes = metrics::score_case(evidence, {}, result);
  result.notes.insert(result.notes.end(), notes.begin(), notes.end());
}

void score_solution(const GraphSize& size, const solve::SolveRun& run, RunResult& result) {
  result.factors = size.num_factors;
  result.variables = size.num_variables;
  result.relinearised = run.num_relinearized;
  // Solvers that factorise everything anew count no variables.
  if (run.num_eliminated > 0) result.eliminated = run.num_eliminated;
  if (run.num_factor_nonzeros > 0) result.factor_nonzeros = run.num_factor_nonzeros;
  result.iterations = run.num_iterations;
  result.notes.insert(result.notes.end(), run.notes.begin(), run.notes.end());
  result.chi2 = run.chi2;
  result.chi2_initial = run.chi2_initial;
  if (run.chi2 && *result.chi2_best > results::kExactFit_chi2) {
    result.chi2_gap_ratio = *run.chi2 / *result.chi2_best - 1;
  }
}

void score_rejection(const formats::PoseGraph& graph, const solve::SolveOptions& options,
                     const solve::SolveRun& run, RunResult& result) {
  if (options.num_planted == 0 && !run.rejected) return;
  result.false_closures = static_cast<std::int64_t>(options.num_planted);
  if (!run.rejected) return;
  result.rejected_closures = static_cast<std::int64_t>(run.rejected->size());
  const solve::RejectionScore score =
      solve::score_of(*run.rejected, graph.edges.size() - options.num_planted, graph.edges.size());
  result.rejection_precision = score.precision;
  result.rejection_recall = score.recall;
}

void score_times(solve::Mode mode, const solve::SolveRun& run, RunResult& result) {
  result.wall_s = run.total_s;
  result.cpu_s = run.cpu_s;
  result.peak_rss_mib = run.peak_rss_mib;
  result.peak_growth_mib = run.peak_growth_mib;
  if (mode == solve::Mode::kBatch) {
    result.init_s = run.init_s;
    result.stages = {stage_times(Stage::kPreprocess, std::vector{run.init_s}),
                     stage_times(Stage::kOptimise, std::vector{run.total_s - run.init_s})};
    return;
  }
  // Lost at its first pose.
  if (run.updates_s.empty()) return;
  const double updates_s = std::accumulate(run.updates_s.begin(), run.updates_s.end(), 0.0);
  score_steps(run.updates_s, result);
  result.step_mean_us = kMicroseconds * updates_s / static_cast<double>(run.updates_s.size());
  result.stages = {stage_times(Stage::kOptimise, run.updates_s),
                   stage_times(Stage::kOther, std::vector{run.total_s - updates_s})};
}

void score_trace(const std::vector<solve::Checkpoint>& checkpoints, RunResult& result) {
  std::vector<double> gaps;
  double newest_gap_m = 0;
  for (const solve::Checkpoint& checkpoint : checkpoints) {
    newest_gap_m = std::max(newest_gap_m, checkpoint.newest_gap_m);
    // Before the first closure every edge fits.
    if (checkpoint.chi2_optimum > results::kExactFit_chi2) {
      gaps.push_back(checkpoint.chi2 / checkpoint.chi2_optimum - 1);
    }
  }
  if (!checkpoints.empty()) result.run_newest_gap_max_m = newest_gap_m;
  result.run_gap_p50_ratio = statistics::median(gaps);
  result.run_gap_max_ratio = statistics::percentile(gaps, 100);
}

void settle_status(const GraphSize& size, solve::Mode mode, const solve::SolveRun& run,
                   RunResult& result) {
  result.status = CaseStatus::kOk;
  // An update of an incremental solution promises no convergence.
  const bool has_stopped_early =
      run.status == SolveStatus::kMaxIterations && mode == solve::Mode::kBatch;
  if (run.status == SolveStatus::kRankDeficient) {
    result.status = CaseStatus::kFailed;
    result.status_message = run.status_message;
  } else if (run.status == SolveStatus::kNotFinite || has_stopped_early) {
    result.status = CaseStatus::kDiverged;
    result.status_message = run.status_message;
  } else if (const std::optional<std::string> reason = why_lost(size, result)) {
    result.status = CaseStatus::kDiverged;
    result.status_message = *reason;
  }
}

}  // namespace corridor::runner
