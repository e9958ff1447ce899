// A Manhattan-like world as a pose graph: a robot that walks the streets of a grid, a metre per
// pose, with a closure wherever it stands again where it stood. With these numbers the graph of
// 3500 poses has 5000 edges and 12 Mflop of block factorisation; M3500 5500 and 9.
// It has no scans and no clock: graphs are for back-ends alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

struct ManhattanWalk {
  struct Edge {
    std::uint32_t i, j;  // i < j
  };
  std::vector<Pose2> true_poses;
  std::vector<Edge> edges;  // those of pose j after those of pose j - 1, odometry first
};

ManhattanWalk walk_manhattan(Rng& rng, std::uint32_t num_poses);

// What decides about a walk's graph, and its name among data sets: "walk-1000-s7".
struct WalkName {
  std::uint32_t num_poses = 0;
  std::uint64_t seed = 0;
};
// nullopt for every other name, and for fewer than two or more than kMaxWalkPoses poses.
inline constexpr std::uint32_t kMaxWalkPoses = 1'000'000;
std::optional<WalkName> walk_name_from(std::string_view name);

struct WalkGraph {
  formats::PoseGraph graph;  // its vertices at chained odometry
  std::vector<Pose2> true_poses;
};

// Every edge measures with white noise of 0.05 m in x and in y and of 0.02 rad, and states its
// information so.
WalkGraph walk_graph(const WalkName& name);

}  // namespace corridor::simulation
