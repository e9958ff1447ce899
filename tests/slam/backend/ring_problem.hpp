// Small pose graphs with a known structure, for tests of back-ends.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/graph/any_factor.hpp"

namespace corridor::backend::testing {

struct PoseGraph {
  std::vector<std::vector<graph::NewFactor>> steps;  // factors that arrive with each pose
  graph::Values initial;
};

inline graph::RelativePose edge(std::uint32_t i, std::uint32_t j, const Pose2& T_i_j) {
  const Eigen::Vector3d weight(10, 10, 30);
  return {graph::pose_key(i), graph::pose_key(j), T_i_j, weight.asDiagonal().toDenseMatrix()};
}

inline graph::PosePrior prior(std::uint32_t i, const Pose2& T_map_base = {}) {
  return {graph::pose_key(i), T_map_base, 1e3 * Eigen::Matrix3d::Identity()};
}

inline Pose2 noisy(Rng& rng, const Pose2& pose) {
  return pose * Pose2::exp({rng.normal(0, 0.05), rng.normal(0, 0.05), rng.normal(0, 0.02)});
}

// A robot that drives two rounds of a ring, with a closure at each pose of the second.
inline PoseGraph ring(std::uint64_t seed) {
  Rng rng(seed);
  constexpr std::uint32_t kRound = 12;
  const Pose2 step(1, 0, 2 * std::numbers::pi / kRound);
  PoseGraph problem;
  Pose2 dead_reckoning;
  for (std::uint32_t i = 0; i < 2 * kRound; ++i) {
    std::vector<graph::NewFactor> factors;
    if (i == 0) {
      factors.push_back(prior(0));
    } else {
      const Pose2 measured = noisy(rng, step);
      dead_reckoning = dead_reckoning * measured;
      factors.push_back(edge(i - 1, i, measured));
    }
    if (i >= kRound) factors.push_back(edge(i - kRound, i, noisy(rng, Pose2())));
    problem.initial.set_pose(i, dead_reckoning);
    problem.steps.push_back(std::move(factors));
  }
  return problem;
}

inline double largest_difference(const graph::Values& a, const graph::Values& b) {
  double largest = 0;
  for (const graph::Key key : a.keys()) {
    largest = std::max(largest, a.pose(key.index).minus(b.pose(key.index)).norm());
  }
  return largest;
}

}  // namespace corridor::backend::testing
