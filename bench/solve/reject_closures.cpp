#include "bench/solve/reject_closures.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/solve/replay.hpp"
#include "slam/backend/robust/pairwise_consistency.hpp"
#include "slam/core/chi_squared.hpp"
#include "slam/core/expect.hpp"

namespace corridor::solve {

using graph::FactorId;

graph::NewFactor Problem::edge(FactorId id) const {
  return graph.factors.visit(id, [&](const auto& factor, const graph::RobustKernel&) {
    return graph::NewFactor(factor, kernels[id]);
  });
}

graph::FactorGraph Problem::kept() const {
  graph::FactorGraph factors = graph.factors;
  for (FactorId id = 0; id < kernels.size(); ++id) {
    if (is_rejected(id)) factors.remove(id);
  }
  return factors;
}

double Problem::chi2(const graph::Values& values, std::size_t num_left_out) const {
  if (measure == Measure::kCost) return cost(values);
  CORRIDOR_EXPECT(num_left_out <= kernels.size());
  double sum = 0;
  for (FactorId id = 0; id < kernels.size() - num_left_out; ++id) {
    sum += graph.factors.chi2(id, values);
  }
  return sum;
}

double Problem::cost(const graph::Values& values) const {
  double sum = 0;
  for (FactorId id = 0; id < kernels.size(); ++id) {
    sum += kernels[id].cost(graph.factors.chi2(id, values));
  }
  return sum;
}

bool looks_for_false_closures(const SolveOptions& options) {
  return options.rejection != Rejection::kNone || options.kernel.kind != graph::KernelKind::kNone;
}

std::vector<FactorId> beyond_bound(const Problem& problem, const graph::Values& values,
                                   double inlier_probability) {
  const double bound = chi_squared_quantile(inlier_probability, graph::RelativePose::kRows);
  std::vector<FactorId> beyond;
  for (const FactorId id : problem.closures) {
    if (problem.graph.factors.chi2(id, values) > bound) beyond.push_back(id);
  }
  return beyond;
}

Result<void> reject_before_solving(const SolveOptions& options, Problem& problem, SolveRun& run) {
  if (options.rejection != Rejection::kPcm) return {};
  backend::PcmParams params;
  params.inlier_probability = options.inlier_probability;
  auto found = backend::pairwise_consistency(problem.graph.factors, problem.graph.values,
                                             problem.held, problem.closures, params);
  if (!found) return tl::make_unexpected(found.error());
  for (const FactorId id : found->rejected) problem.reject(id);
  run.rejected = std::move(found->rejected);
  if (!found->is_proven) {
    run.notes.push_back(fmt::format(
        "a larger set of consistent closures may exist: the search ended after {} branches",
        params.max_branches));
  }
  return {};
}

std::string reject_while_solving(const SolveOptions& options, Problem& problem,
                                 graph::Values& values, SolveRun& run) {
  const bool is_truncated = options.rejection == Rejection::kGnc;
  if (!is_truncated && options.rejection != Rejection::kGncGemanMcClure) return "";
  CORRIDOR_EXPECT(options.make_back_end);
  graph::FactorGraph factors = problem.graph.factors;
  for (const graph::NewFactor& prior : problem.priors) factors.add(prior);
  backend::GncParams params;
  params.inlier_probability = options.inlier_probability;
  const auto loss = is_truncated ? backend::GncLoss::kTruncated : backend::GncLoss::kGemanMcClure;
  backend::GncResult found = backend::graduated_non_convexity(factors, values, problem.closures,
                                                              loss, options.make_back_end, params);
  for (std::size_t k = 0; is_truncated && k < problem.closures.size(); ++k) {
    problem.kernels[problem.closures[k]] = backend::kernel_of_weight(found.weights[k]);
  }
  for (const FactorId id : found.rejected) problem.reject(id);
  run.num_iterations += found.num_iterations;
  run.rejected = std::move(found.rejected);
  values = std::move(found.values);
  switch (found.status) {
    case backend::GncStatus::kConverged:
      return "";
    case backend::GncStatus::kMaxRounds:
      return "the limit of rounds came before every closure was in or out";
    case backend::GncStatus::kNotSolvable:
      return "weights of closures are open: " + message_of(found.solution);
  }
  return "";
}

}  // namespace corridor::solve
