// The optimum that solutions are compared with: the smallest chi2 that our own least squares find
// when they go on until nothing moves. Near a good start that is the optimum; from far away nobody
// can promise it.
#pragma once

#include <vector>

#include "bench/solve/recording.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::solve {

// What the chi2 of a solution is.
enum class Measure {
  kEdges,  // of pose graphs, as published: e^T Omega e of the edges; priors and kernels left out
  kCost,   // of recordings, where priors are measurements too: every factor under its kernel
};

struct Optimum {
  graph::Values values;
  double chi2 = 0;
};

// By kEdges factors between several variables are edges, and priors are those on one.
double chi2_of(const graph::FactorGraph& graph, const graph::Values& values, Measure measure);

// The best of all ways down: Gauss-Newton from every start and, if none leads below the first
// start, damped from there. Never worse than the first start. Requires a start.
Optimum optimum_near(const graph::FactorGraph& graph, const std::vector<graph::Values>& starts,
                     Measure measure = Measure::kEdges);

// Of a whole graph, held like solve_graph() holds it: from chordal relaxation and from the file's
// poses. The Error is that of solve_graph().
Result<Optimum> optimum_of(const formats::PoseGraph& graph);

// Of what a recording ends with: from where its own system had it.
Optimum optimum_of(const Recording& recording);

}  // namespace corridor::solve
