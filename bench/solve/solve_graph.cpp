#include "bench/solve/solve_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "bench/runner/process_clock.hpp"
#include "bench/solve/held_poses.hpp"
#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"

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

struct Problem {
  formats::GraphProblem graph;  // edges alone
  std::vector<std::uint32_t> held;
  std::vector<NewFactor> priors;
  graph::RobustKernel kernel;

  // An edge by its number in the file.
  [[nodiscard]] NewFactor edge(graph::FactorId id) const {
    return graph.factors.visit(id, [this](const auto& factor, const graph::RobustKernel&) {
      return NewFactor(factor, kernel);
    });
  }
};

Problem problem_of(const formats::PoseGraph& graph, const graph::RobustKernel& kernel) {
  Problem problem{formats::factor_graph_of(graph), held_poses(graph), {}, kernel};
  for (graph::PosePrior& prior : priors_on(problem.held, graph, problem.graph.values)) {
    problem.priors.emplace_back(std::move(prior));
  }
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
}

Result<graph::Values> initial_values(const Problem& problem, Initialization init) {
  const graph::FactorGraph& factors = problem.graph.factors;
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

Result<void> solve_batch(const Problem& problem, BackEnd& back_end, Initialization init,
                         SolveRun& run) {
  const Clock::time_point start = Clock::now();
  const Result<graph::Values> values = initial_values(problem, init);
  if (!values) return tl::make_unexpected(values.error());
  run.init_s = seconds_since(start);
  back_end.add(problem.priors, *values);
  const graph::FactorId end = problem.graph.factors.end_id();
  for (graph::FactorId first = 0; first < end; first += kFactorsPerCall) {
    std::vector<NewFactor> edges;
    edges.reserve(kFactorsPerCall);
    for (graph::FactorId id = first; id < std::min(first + kFactorsPerCall, end); ++id) {
      edges.push_back(problem.edge(id));
    }
    back_end.add(std::move(edges), {});
  }
  count(back_end.solve(), run);
  run.total_s = seconds_since(start);
  run.chi2_initial = problem.graph.factors.chi2(*values);
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
Pose2 predicted(const Problem& problem, const Placement& step, const graph::Values& new_values,
                BackEnd& back_end) {
  if (step.edge == nullptr) return problem.graph.values.pose(step.pose);
  const bool is_new = new_values.contains(graph::pose_key(step.parent()));
  const Pose2 parent = is_new ? new_values.pose(step.parent()) : back_end.pose(step.parent());
  return parent * step.T_parent_pose();
}

// The estimate of the pose before this one, or the edge to it, leads beyond all numbers.
Result<void> lose(std::uint32_t pose, SolveRun& run) {
  run.status = SolveStatus::kNotFinite;
  run.status_message = graph::to_text(graph::pose_key(pose)) + " starts at no finite value";
  return {};
}

Result<void> solve_incrementally(const Problem& problem, BackEnd& back_end,
                                 const SolveOptions& options, SolveRun& run) {
  const Clock::time_point start = Clock::now();
  const auto order =
      backend::spanning_order(problem.graph.factors, problem.graph.values, problem.held);
  if (!order) return tl::make_unexpected(order.error());
  const auto arrivals = edges_by_arrival(problem, *order);
  const auto group = static_cast<std::size_t>(options.poses_per_update);
  for (std::size_t first = 0; first < order->size() && !has_failed(run.status); first += group) {
    const std::size_t end = std::min(first + group, order->size());
    std::vector<NewFactor> factors;
    // Held poses come first, in the order of their priors.
    for (std::size_t k = first; k < std::min(end, problem.priors.size()); ++k) {
      factors.push_back(problem.priors[k]);
    }
    for (std::size_t k = first; k < end; ++k) {
      for (const graph::FactorId id : arrivals[k]) factors.push_back(problem.edge(id));
    }
    const Clock::time_point update_start = Clock::now();
    graph::Values values;
    for (std::size_t k = first; k < end; ++k) {
      const Pose2 T_map_base = predicted(problem, (*order)[k], values, back_end);
      if (!T_map_base.is_finite()) return lose((*order)[k].pose, run);
      values.set_pose((*order)[k].pose, T_map_base);
    }
    const BackEndReport report = back_end.update(std::move(factors), values, {});
    const std::uint32_t newest = (*order)[end - 1].pose;
    const Pose2 T_map_newest = back_end.pose(newest);
    run.updates_s.push_back(seconds_since(update_start));
    run.updates.push_back(
        {newest, T_map_newest, end, report.num_relinearized, report.num_eliminated});
    count(report, run);
    if (options.after_update) options.after_update(back_end, run.updates.back());
  }
  run.total_s = seconds_since(start);
  return {};
}

double cost_of(const Problem& problem, const graph::Values& values) {
  double sum = 0;
  for (graph::FactorId id = 0; id < problem.graph.factors.end_id(); ++id) {
    sum += problem.kernel.cost(problem.graph.factors.chi2(id, values));
  }
  return sum;
}

std::int64_t num_singular(const formats::PoseGraph& graph) {
  return std::count_if(graph.edges.begin(), graph.edges.end(), [](const auto& edge) {
    const Eigen::Matrix3d root = graph::square_root_information(edge.information);
    return root.rowwise().squaredNorm().minCoeff() == 0;
  });
}

}  // namespace

Result<SolveRun> solve_graph(const formats::PoseGraph& graph, BackEnd& back_end,
                             const SolveOptions& options) {
  const Problem problem = problem_of(graph, options.kernel);
  SolveRun run;
  runner::reset_peak_rss();
  const double cpu_before_s = runner::process_cpu_s();
  const Result<void> done = options.mode == Mode::kBatch
                                ? solve_batch(problem, back_end, options.init, run)
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
  run.chi2 = problem.graph.factors.chi2(back_end.estimate());
  run.cost = cost_of(problem, back_end.estimate());
  return run;
}

}  // namespace corridor::solve
