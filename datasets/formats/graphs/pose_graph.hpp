// A planar pose graph as files hold it: poses, relative poses with their information, poses that
// are held. Plain numbers, so that converting between file formats changes none of them; solvers
// take factor_graph_of().
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::formats {

// Values keep a slot for every index up to the largest, so that an absurd id is an absurd
// allocation: the largest graphs in use have some 1e5 poses.
inline constexpr std::uint32_t kMaxPoseId = (1u << 22) - 1;

struct PoseGraph {
  struct Vertex {
    std::uint32_t id = 0;
    Pose2 T_map_base;  // initial guess
  };
  struct Edge {
    std::uint32_t i = 0;
    std::uint32_t j = 0;
    Pose2 T_i_j;  // measured
    // 3x3, symmetric, order (x_m, y_m, theta_rad); of g2o's error (RelativePoseError::kComponents).
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  };

  std::vector<Vertex> vertices;  // in the order of the file
  std::vector<Edge> edges;       // in the order of the file
  std::vector<std::uint32_t> fixed;
  // Counted oddities that a reader let through: "145 edges repeat a pair of poses".
  std::vector<std::string> notes;
};

// Sets of poses that edges join; a pose without an edge is a part of its own. More than one part
// with fewer fixed poses than parts cannot be solved. Every edge must name vertices of the graph.
std::size_t num_parts(const PoseGraph& graph);

// Edges whose two poses an earlier edge joins already, in whichever direction.
std::size_t num_repeated_pairs(const PoseGraph& graph);

struct GraphProblem {
  graph::FactorGraph factors;  // a RelativePose of kComponents per edge, in the edges' order
  graph::Values values;
};

// Priors on fixed poses are not among the factors: how hard a pose is held is the solver's to say,
// and chi2 as published does not count them.
GraphProblem factor_graph_of(const PoseGraph& graph);

}  // namespace corridor::formats
