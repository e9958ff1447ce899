// Relative poses along odometry with their covariances, for any two poses in O(log n).
// Every edge's noise is brought into the frame of the root, where covariances of independent edges
// add: with S_i the sum along the way from the root to i and m where the ways to i and j part,
//   Cov(T_i_j) = Ad(T_root_j)^-1 (S_i + S_j - 2 S_m) Ad(T_root_j)^-T,
// perturbed on the right, order (x_m, y_m, theta_rad) [Sola2018] eq. 54, [Barfoot2017] 7.3.3.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::backend {

struct UncertainPose {
  Pose2 T;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // in the frame of the target
};

// Of a relative pose; the Error names the edge if its information has no inverse.
Result<UncertainPose> uncertain_pose(const graph::RelativePose& edge);

class OdometryTree {
 public:
  // The tree of spanning_order(). Held poses besides the first count as exactly known. The Error
  // names an edge without covariance, or a pose that no edges join to a held one.
  static Result<OdometryTree> of(const graph::FactorGraph& graph, const graph::Values& values,
                                 std::span<const std::uint32_t> held);

  // Requires poses of the graph.
  [[nodiscard]] UncertainPose between(std::uint32_t pose_i, std::uint32_t pose_j) const;

 private:
  struct Node {
    std::uint32_t depth = 0;
    std::uint32_t parent = 0;
    // An ancestor far above: ways to the common one jump there [Myers1983].
    std::uint32_t jump = 0;
    Pose2 T_root_pose;
    Eigen::Matrix3d covariance_in_root = Eigen::Matrix3d::Zero();
  };

  [[nodiscard]] std::uint32_t common_ancestor(std::uint32_t a, std::uint32_t b) const;

  std::vector<Node> nodes_;  // by pose
};

}  // namespace corridor::backend
