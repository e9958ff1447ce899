#include "bench/solve/solve_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "bench/runner/process_clock.hpp"
#include "bench/solve/held_poses.hpp"
#include "bench/solve/reject_closures.hpp"
#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/backend/robust/loop_closures.hpp"

namespace corridor::solve {
namespace {

using backend::BackEnd;
using backend::BackEndReport;
using backend::Placement;
using backend::SolveStatus;
using graph::NewFactor;
using Clock = std::chrono::steady_clock;

// Factors on their way into a back-end are larger than in it: a million at a time would be what
// decides about the peak of memory.
constexpr std::size_t kFactorsPerCall = 4096;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<Problem> problem_of(const formats::PoseGraph& graph, const SolveOptions& options) {
  Problem problem{formats::factor_graph_of(graph), held_poses(graph), {}, {}, {}};
  for (graph::PosePrior& prior : priors_on(problem.held, graph, problem.graph.values)) {
    problem.priors.emplace_back(std::move(prior));
  }
  const graph::FactorId end = problem.graph.factors.end_id();
  const bool is_for_closures = options.kernel.kind == graph::KernelKind::kDcs;
  problem.kernels.assign(end, is_for_closures ? graph::RobustKernel() : options.kernel);
  if (!looks_for_false_closures(options)) return problem;
  auto closures = backend::loop_closures(problem.graph.factors, problem.graph.values, problem.held);
  if (!closures) return tl::make_unexpected(closures.error());
  problem.closures = std::move(*closures);
  for (const graph::FactorId id : problem.closures) problem.kernels[id] = options.kernel;
  return problem;
}

// An update that failed ends an incremental solution; one that has not converged does not.
bool has_failed(SolveStatus status) {
  return status == SolveStatus::kRankDeficient || status == SolveStatus::kNotFinite;
}

std::string message_of(const BackEndReport& report) {
  switch (report.status) {
    case SolveStatus::kRankDeficient:
      return report.undetermined ? graph::to_text(*report.undetermined) + " is undetermined"
                                 : "some pose is undetermined";
    case SolveStatus::kNotFinite:
      return "a residual or its derivative is not finite";
    case SolveStatus::kMaxIterations:
      return "the limit of iterations came before convergence";
    case SolveStatus::kConverged:
    case SolveStatus::kEmpty:
      return "";
  }
  return "";
}

void count(const BackEndReport& report, SolveRun& run) {
  run.status = report.status;
  run.status_message = message_of(report);
  run.num_iterations += report.num_iterations;
  run.num_relinearized += report.num_relinearized;
  run.num_eliminated += report.num_eliminated;
  run.num_dropped += report.num_dropped_factors;
}

Result<graph::Values> initial_values(const Problem& problem, const graph::FactorGraph& factors,
                                     Initialization init) {
  const graph::Values& values = problem.graph.values;
  if (init == Initialization::kOdometry) {
    return backend::odometry_initialization(factors, values, problem.held);
  }
  if (init == Initialization::kChordal) {
    return backend::chordal_initialization(factors, values, problem.held);
  }
  // The file's own; that it can be solved is checked all the same.
  const auto order = backend::spanning_order(factors, values, problem.held);
  if (!order) return tl::make_unexpected(order.error());
  return values;
}

Result<void> solve_batch(Problem& problem, BackEnd& back_end, const SolveOptions& options,
                         SolveRun& run) {
  const Clock::time_point start = Clock::now();
  if (const auto done = reject_before_solving(options, problem, run); !done) return done;
  Result<graph::Values> values = run.rejected
                                     ? initial_values(problem, problem.kept(), options.init)
                                     : initial_values(problem, problem.graph.factors, options.init);
  if (!values) return tl::make_unexpected(values.error());
  run.init_s = seconds_since(start);
  run.chi2_initial = problem.chi2(*values, options.num_planted);
  const bool is_rejection_done = reject_while_solving(options, problem, *values, run);
  back_end.add(problem.priors, *values);
  const graph::FactorId end = problem.graph.factors.end_id();
  for (graph::FactorId first = 0; first < end; first += kFactorsPerCall) {
    std::vector<NewFactor> edges;
    edges.reserve(kFactorsPerCall);
    for (graph::FactorId id = first; id < std::min(first + kFactorsPerCall, end); ++id) {
      if (!problem.is_rejected(id)) edges.push_back(problem.edge(id));
    }
    back_end.add(std::move(edges), {});
  }
  count(back_end.solve(), run);
  run.total_s = seconds_since(start);
  if (!is_rejection_done && run.status == SolveStatus::kConverged) {
    run.status = SolveStatus::kMaxIterations;
    run.status_message = "the limit of rounds came before every closure was in or out";
  }
  return {};
}

// The edges that arrive with every pose: those to poses placed before it.
std::vector<std::vector<graph::FactorId>> edges_by_arrival(const Problem& problem,
                                                           const std::vector<Placement>& order) {
  std::vector<std::size_t> arrival;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k].pose >= arrival.size()) arrival.resize(order[k].pose + 1);
    arrival[order[k].pose] = k;
  }
  std::vector<std::vector<graph::FactorId>> edges(order.size());
  for (graph::FactorId id = 0; id < problem.graph.factors.end_id(); ++id) {
    const std::span<const graph::Key> keys = problem.graph.factors.keys(id);
    edges[std::max(arrival[keys[0].index], arrival[keys[1].index])].push_back(id);
  }
  return edges;
}

// Where the edge to the earlier pose says that a new pose is.
Pose2 predicted(const Problem& problem, const Placement& step, BackEnd& back_end) {
  if (step.edge == nullptr) return problem.graph.values.pose(step.pose);
  return back_end.pose(step.parent()) * step.T_parent_pose();
}

// The estimate of the pose before this one, or the edge to it, leads beyond all numbers.
Result<void> lose(std::uint32_t pose, SolveRun& run) {
  run.status = SolveStatus::kNotFinite;
  run.status_message = graph::to_text(graph::pose_key(pose)) + " starts at no finite value";
  return {};
}

// The prior, if the pose is held, and the edges that arrive with the k-th pose. Held poses come
// first, in the order of their priors.
std::vector<NewFactor> factors_of(const Problem& problem, std::size_t k,
                                  const std::vector<graph::FactorId>& edges) {
  std::vector<NewFactor> factors;
  if (k < problem.priors.size()) factors.push_back(problem.priors[k]);
  for (const graph::FactorId id : edges) factors.push_back(problem.edge(id));
  return factors;
}

void converge(BackEnd& back_end, SolveRun& run) {
  const Clock::time_point start = Clock::now();
  const BackEndReport report = back_end.update_until_converged({});
  run.converge_rounds = report.num_iterations;
  count(report, run);
  run.converge_s = seconds_since(start);
}

Result<void> solve_incrementally(const Problem& problem, BackEnd& back_end,
                                 const SolveOptions& options, SolveRun& run) {
  const Clock::time_point start = Clock::now();
  const auto order =
      backend::spanning_order(problem.graph.factors, problem.graph.values, problem.held);
  if (!order) return tl::make_unexpected(order.error());
  const auto arrivals = edges_by_arrival(problem, *order);
  const auto every = static_cast<std::size_t>(options.poses_per_update);
  for (std::size_t k = 0; k < order->size() && !has_failed(run.status); ++k) {
    const std::uint32_t pose = (*order)[k].pose;
    std::vector<NewFactor> factors = factors_of(problem, k, arrivals[k]);
    const Clock::time_point step_start = Clock::now();
    const Pose2 T_map_base = predicted(problem, (*order)[k], back_end);
    if (!T_map_base.is_finite()) return lose(pose, run);
    graph::Values values;
    values.set_pose(pose, T_map_base);
    BackEndReport report;
    const bool is_solved = (k + 1) % every == 0 || k + 1 == order->size();
    if (is_solved) {
      report = back_end.update(std::move(factors), values, {});
    } else {
      (void)back_end.add(std::move(factors), values);
    }
    const Pose2 T_map_newest = back_end.pose(pose);
    run.updates_s.push_back(seconds_since(step_start));
    run.updates.push_back(
        {pose, T_map_newest, k + 1, report.num_relinearized, report.num_eliminated});
    if (is_solved) count(report, run);
    if (options.after_update) options.after_update(back_end, run.updates.back());
  }
  if (options.do_converge && !has_failed(run.status)) converge(back_end, run);
  run.total_s = seconds_since(start);
  return {};
}

std::int64_t num_singular(const formats::PoseGraph& graph) {
  return std::count_if(graph.edges.begin(), graph.edges.end(), [](const auto& edge) {
    const Eigen::Matrix3d root = graph::square_root_information(edge.information);
    return root.rowwise().squaredNorm().minCoeff() == 0;
  });
}

}  // namespace

std::string_view to_text(Initialization init) {
  switch (init) {
    case Initialization::kFile:
      return "file";
    case Initialization::kOdometry:
      return "odometry";
    case Initialization::kChordal:
      return "chordal";
  }
  return "";
}

Result<SolveRun> solve_graph(const formats::PoseGraph& graph, BackEnd& back_end,
                             const SolveOptions& options) {
  Result<Problem> made = problem_of(graph, options);
  if (!made) return tl::make_unexpected(made.error());
  Problem& problem = *made;
  SolveRun run;
  runner::reset_peak_rss();
  const double cpu_before_s = runner::process_cpu_s();
  const Result<void> done = options.mode == Mode::kBatch
                                ? solve_batch(problem, back_end, options, run)
                                : solve_incrementally(problem, back_end, options, run);
  if (!done) return tl::make_unexpected(done.error());
  run.cpu_s = runner::process_cpu_s() - cpu_before_s;
  run.peak_rss_mib = runner::peak_rss_mib();
  if (run.status == SolveStatus::kRankDeficient) {
    if (const std::int64_t singular = num_singular(graph); singular > 0) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("{}: {} edges with singular information leave directions free",
                              run.status_message, singular),
                  "", "edges that determine every pose");
    }
  }
  if (options.mode == Mode::kIncremental && has_failed(run.status)) return run;
  run.chi2 = problem.chi2(back_end.estimate(), options.num_planted);
  run.cost = problem.cost(back_end.estimate());
  if (options.kernel.kind != graph::KernelKind::kNone) {
    run.rejected = beyond_bound(problem, back_end.estimate(), options.inlier_probability);
  }
  return run;
}

}  // namespace corridor::solve
