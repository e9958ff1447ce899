#include "bench/solve/solve_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "bench/runner/process_clock.hpp"
#include "bench/solve/held_poses.hpp"
#include "bench/solve/pose_graph_steps.hpp"
#include "bench/solve/reject_closures.hpp"
#include "bench/solve/replay.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/backend/robust/loop_closures.hpp"
#include "slam/core/expect.hpp"

namespace corridor::solve {
namespace {

using backend::BackEnd;
using backend::has_failed;
using backend::SolveStatus;
using graph::NewFactor;

// Factors on their way into a back-end are larger than in it: a million at a time would be what
// decides about the peak of memory.
constexpr std::size_t kFactorsPerCall = 4096;

Problem problem_of(const Recording& recording) {
  Problem problem{{recording.factors(), recording.initial_values()}, {}, {}, {}, {}};
  problem.measure = Measure::kCost;
  for (graph::FactorId id = 0; id < problem.graph.factors.end_id(); ++id) {
    problem.kernels.push_back(problem.graph.factors.kernel(id));
  }
  return problem;
}

Result<Problem> problem_of(const formats::PoseGraph& graph, const SolveOptions& options) {
  Problem problem{formats::factor_graph_of(graph), held_poses(graph), {}, {}, {}};
  for (graph::PosePrior& prior : priors_on(problem.held, graph, problem.graph.values)) {
    problem.priors.emplace_back(std::move(prior));
  }
  const graph::FactorId end = problem.graph.factors.end_id();
  problem.kernels.assign(end, {});
  if (!looks_for_false_closures(options)) return problem;
  auto closures = backend::loop_closures(problem.graph.factors, problem.graph.values, problem.held);
  if (!closures) return tl::make_unexpected(closures.error());
  problem.closures = std::move(*closures);
  for (const graph::FactorId id : problem.closures) problem.kernels[id] = options.kernel;
  return problem;
}

Result<graph::Values> initial_values(const Problem& problem, const graph::FactorGraph& factors,
                                     Initialization init) {
  const graph::Values& values = problem.graph.values;
  if (problem.held.empty()) return values;  // of a recording, which has priors of its own
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

void add_edges(const Problem& problem, BackEnd& back_end) {
  const graph::FactorId end = problem.graph.factors.end_id();
  for (graph::FactorId first = 0; first < end; first += kFactorsPerCall) {
    std::vector<NewFactor> edges;
    edges.reserve(kFactorsPerCall);
    for (graph::FactorId id = first; id < std::min(first + kFactorsPerCall, end); ++id) {
      if (!problem.is_rejected(id)) edges.push_back(problem.edge(id));
    }
    back_end.add(std::move(edges), {});
  }
}

Result<void> solve_batch(Problem& problem, BackEnd& back_end, const SolveOptions& options,
                         runner::Stopwatch& clock, SolveRun& run) {
  clock.start();
  if (const auto done = reject_before_solving(options, problem, run); !done) return done;
  Result<graph::Values> values = run.rejected
                                     ? initial_values(problem, problem.kept(), options.init)
                                     : initial_values(problem, problem.graph.factors, options.init);
  if (!values) return tl::make_unexpected(values.error());
  clock.stop();
  run.init_s = clock.wall_s();
  run.chi2_initial = problem.chi2(*values, options.num_planted);
  clock.start();
  const std::string why_open = reject_while_solving(options, problem, *values, run);
  back_end.add(problem.priors, *values);
  add_edges(problem, back_end);
  count(back_end.solve(), run);
  clock.stop();
  if (!why_open.empty() && !has_failed(run.status)) {
    run.status = SolveStatus::kMaxIterations;
    run.status_message = why_open;
  }
  return {};
}

Result<void> solve_incrementally(const Problem& problem, const Recording* recording,
                                 BackEnd& back_end, const SolveOptions& options,
                                 runner::Stopwatch& clock, SolveRun& run) {
  clock.start();
  const Result<Steps> steps = recording != nullptr
                                  ? steps_of(*recording)
                                  : pose_graph_steps(problem, options.poses_per_update);
  if (!steps) return tl::make_unexpected(steps.error());
  auto done = replay(*steps, back_end, options, run);
  // Whoever wants the whole solution has to read it, which a lazy solver does then.
  if (!has_failed(run.status)) (void)back_end.estimate();
  clock.stop();
  return done;
}

std::int64_t num_singular(const formats::PoseGraph& graph) {
  return std::count_if(graph.edges.begin(), graph.edges.end(), [](const auto& edge) {
    const Eigen::Matrix3d root = graph::square_root_information(edge.information);
    return root.rowwise().squaredNorm().minCoeff() == 0;
  });
}

// A damped solver converges wherever it stands along a direction that no edge determines: ours,
// which is not, is asked at the solution.
void check_determined(const Problem& problem, const graph::Values& solution, SolveRun& run) {
  backend::LeastSquaresParams params;
  params.max_iterations = 1;
  const auto solver = backend::make_least_squares(params);
  solver->add(problem.priors, solution);
  add_edges(problem, *solver);
  const backend::BackEndReport report = solver->solve();
  if (report.status != SolveStatus::kRankDeficient) return;
  run.status = report.status;
  run.status_message = message_of(report);
}

// Poses that come one by one have to be determined as they come.
std::string expected_of(const SolveOptions& options, std::size_t num_poses, const SolveRun& run) {
  if (options.mode == Mode::kBatch || run.online.size() >= num_poses) {
    return "edges that determine every pose";
  }
  return fmt::format("edges that determine every pose when it comes (this is number {} of {})",
                     run.online.size(), num_poses);
}

// `recording`: where the problem is from; null: a pose graph of a file.
Result<SolveRun> solve(Problem& problem, const Recording* recording, BackEnd& back_end,
                       const SolveOptions& options) {
  SolveRun run;
  const runner::MemoryWatch memory;
  runner::Stopwatch clock;
  const Result<void> done =
      options.mode == Mode::kBatch
          ? solve_batch(problem, back_end, options, clock, run)
          : solve_incrementally(problem, recording, back_end, options, clock, run);
  if (!done) return tl::make_unexpected(done.error());
  run.total_s = clock.wall_s();
  run.cpu_s = clock.cpu_s();
  run.peak_rss_mib = memory.peak_mib();
  run.peak_growth_mib = memory.growth_mib();
  if (options.mode == Mode::kIncremental && has_failed(run.status)) return run;
  graph::Values solution = run.marginalized;
  solution.merge(back_end.estimate());
  run.chi2 = problem.chi2(solution, options.num_planted);
  run.cost = problem.cost(solution);
  return run;
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
  Result<Problem> problem = problem_of(graph, options);
  if (!problem) return tl::make_unexpected(problem.error());
  Result<SolveRun> run = solve(*problem, nullptr, back_end, options);
  if (!run) return run;
  const std::int64_t singular = num_singular(graph);
  if (singular > 0 && run->chi2 && std::isfinite(*run->chi2)) {
    check_determined(*problem, back_end.estimate(), *run);
  }
  if (run->status == SolveStatus::kRankDeficient && singular > 0) {
    return fail(ErrorCode::kInvalid,
                fmt::format("{}: {} edges with singular information leave directions free",
                            run->status_message, singular),
                "", expected_of(options, graph.vertices.size(), *run));
  }
  if (run->chi2 && options.kernel.kind != graph::KernelKind::kNone) {
    run->rejected = beyond_bound(*problem, back_end.estimate(), options.inlier_probability);
  }
  return run;
}

Result<SolveRun> solve_graph(const Recording& recording, BackEnd& back_end,
                             const SolveOptions& options) {
  CORRIDOR_EXPECT(options.init == Initialization::kFile && options.poses_per_update == 1);
  CORRIDOR_EXPECT(!looks_for_false_closures(options) && options.num_planted == 0);
  Problem problem = problem_of(recording);
  return solve(problem, &recording, back_end, options);
}

}  // namespace corridor::solve
