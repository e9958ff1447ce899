// The optimum that solutions are compared with: the smallest chi2 that our own least squares find
// when they go on until nothing moves. Near a good start that is the optimum; from far away nobody
// can promise it.
#pragma once

#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::solve {

struct Optimum {
  graph::Values values;
  double chi2 = 0;  // of the edges; priors and kernels left out
};

// Sum of e^T Omega e over the factors between poses, which priors are not.
double edges_chi2(const graph::FactorGraph& graph, const graph::Values& values);

// The best of all ways down: Gauss-Newton from every start and, if none leads below the first
// start, damped from there. Never worse than the first start. Requires a start.
Optimum optimum_near(const graph::FactorGraph& graph, const std::vector<graph::Values>& starts);

// Of a whole graph, held like solve_graph() holds it: from chordal relaxation and from the file's
// poses. The Error is that of solve_graph().
Result<Optimum> optimum_of(const formats::PoseGraph& graph);

}  // namespace corridor::solve
