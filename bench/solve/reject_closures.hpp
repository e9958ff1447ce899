// A graph on its way into a back-end, and the methods that find false loop closures in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/solve/optimum.hpp"
#include "bench/solve/solve_graph.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"

namespace corridor::solve {

struct Problem {
  formats::GraphProblem graph;  // of a file: edges alone; of a recording: every factor
  std::vector<std::uint32_t> held;
  std::vector<graph::NewFactor> priors;
  std::vector<graph::FactorId> closures;     // empty if nothing asks for them
  std::vector<graph::RobustKernel> kernels;  // by edge; of width 0: rejected
  Measure measure = Measure::kEdges;

  [[nodiscard]] bool is_rejected(graph::FactorId id) const { return kernels[id].width == 0; }
  void reject(graph::FactorId id) { kernels[id] = {graph::KernelKind::kScaled, 0}; }
  // An edge by its number in the file, with its kernel.
  [[nodiscard]] graph::NewFactor edge(graph::FactorId id) const;
  // The edges that are not rejected, under their numbers.
  [[nodiscard]] graph::FactorGraph kept() const;
  // By `measure`; of kEdges over all but the last `num_left_out`.
  [[nodiscard]] double chi2(const graph::Values& values, std::size_t num_left_out) const;
  [[nodiscard]] double cost(const graph::Values& values) const;
};

// Whether `options` treat loop closures otherwise than other edges.
bool looks_for_false_closures(const SolveOptions& options);

// The closures whose chi2 a true one exceeds with probability 1 - inlier_probability at most.
std::vector<graph::FactorId> beyond_bound(const Problem& problem, const graph::Values& values,
                                          double inlier_probability);

// kPcm, which needs no values; a note if its search found no proof. The Error: an edge without
// covariance.
Result<void> reject_before_solving(const SolveOptions& options, Problem& problem, SolveRun& run);

// kGnc: leaves the edges' weights as their kernels, and its solution in `values`; the weights of
// kGncGemanMcClure, which are never 0 or 1, only say which edges are rejected: the others count in
// full. Why it did not come to its end; empty if it did.
std::string reject_while_solving(const SolveOptions& options, Problem& problem,
                                 graph::Values& values, SolveRun& run);

}  // namespace corridor::solve
