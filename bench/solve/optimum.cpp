#include "bench/solve/optimum.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "bench/solve/held_poses.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/initialization/initialization.hpp"

namespace corridor::solve {
namespace {

// Three digits beyond the 1e-6 to which solutions are compared with it, and more steps than any
// descent takes that comes to an end.
constexpr double kMinRelativeDecrease = 1e-12;
constexpr int kMaxIterations = 200;

Optimum descend(const graph::FactorGraph& graph, const graph::Values& start, bool use_damping,
                Measure measure) {
  backend::LeastSquaresParams params;
  params.use_damping = use_damping;
  params.max_iterations = kMaxIterations;
  params.min_relative_decrease = kMinRelativeDecrease;
  const std::unique_ptr<backend::BackEnd> solver = backend::make_least_squares(params);
  std::vector<graph::NewFactor> factors;
  factors.reserve(graph.num_factors());
  graph.for_each([&]<class F>(graph::FactorId, const F& factor, const graph::RobustKernel& kernel) {
    factors.emplace_back(F(factor), kernel);
  });
  solver->add(std::move(factors), start);
  solver->solve();
  return {solver->estimate(), chi2_of(graph, solver->estimate(), measure)};
}

// A chi2 that is not finite is below nothing.
void take_if_below(Optimum candidate, Optimum& best) {
  if (candidate.chi2 < best.chi2) best = std::move(candidate);
}

}  // namespace

double chi2_of(const graph::FactorGraph& graph, const graph::Values& values, Measure measure) {
  if (measure == Measure::kCost) return graph.cost(values);
  double sum = 0;
  for (graph::FactorId id = 0; id < graph.end_id(); ++id) {
    if (graph.contains(id) && graph.keys(id).size() > 1) sum += graph.chi2(id, values);
  }
  return sum;
}

Optimum optimum_near(const graph::FactorGraph& graph, const std::vector<graph::Values>& starts,
                     Measure measure) {
  Optimum best{starts.front(), chi2_of(graph, starts.front(), measure)};
  if (!std::isfinite(best.chi2)) best.chi2 = HUGE_VAL;
  const double chi2_at_start = best.chi2;
  for (const graph::Values& start : starts) {
    take_if_below(descend(graph, start, false, measure), best);
  }
  if (best.chi2 >= chi2_at_start) {
    take_if_below(descend(graph, starts.front(), true, measure), best);
  }
  return best;
}

Result<Optimum> optimum_of(const formats::PoseGraph& graph) {
  formats::GraphProblem problem = formats::factor_graph_of(graph);
  const std::vector<std::uint32_t> held = held_poses(graph);
  auto chordal = backend::chordal_initialization(problem.factors, problem.values, held);
  if (!chordal) return tl::make_unexpected(chordal.error());
  for (graph::PosePrior& prior : priors_on(held, graph, problem.values)) {
    problem.factors.add(std::move(prior));
  }
  return optimum_near(problem.factors, {std::move(*chordal), problem.values});
}

Optimum optimum_of(const Recording& recording) {
  return optimum_near(recording.factors(), {recording.final_estimate}, Measure::kCost);
}

}  // namespace corridor::solve
