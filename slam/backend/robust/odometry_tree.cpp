#include "slam/backend/robust/odometry_tree.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/core/expect.hpp"

namespace corridor::backend {

Result<UncertainPose> uncertain_pose(const graph::RelativePose& edge) {
  const Eigen::LLT<Eigen::Matrix3d> information(edge.information());
  const Eigen::Matrix3d covariance = information.solve(Eigen::Matrix3d::Identity());
  if (information.info() != Eigen::Success || !covariance.allFinite()) {
    return fail(ErrorCode::kInvalid,
                fmt::format("the edge from pose {} to pose {} has singular information",
                            edge.keys()[0].index, edge.keys()[1].index),
                "", "edges with a covariance: their consistency is measured by it");
  }
  return UncertainPose{edge.measured_T_i_j(), covariance};
}

Result<OdometryTree> OdometryTree::of(const graph::FactorGraph& graph, const graph::Values& values,
                                      std::span<const std::uint32_t> held) {
  const auto order = spanning_order(graph, values, held);
  if (!order) return tl::make_unexpected(order.error());
  OdometryTree tree;
  for (const Placement& step : *order) {
    if (step.pose >= tree.nodes_.size()) tree.nodes_.resize(step.pose + 1);
  }
  for (const Placement& step : *order) {
    Node& node = tree.nodes_[step.pose];
    const std::uint32_t parent = step.edge == nullptr ? order->front().pose : step.parent();
    const Node& above = tree.nodes_[parent];
    node.parent = node.jump = parent;
    if (step.edge == nullptr) {
      const Pose2& root = values.pose(order->front().pose);
      node.T_root_pose = root.between(values.pose(step.pose));
      node.depth = step.pose == parent ? 0 : 1;
      continue;
    }
    const Result<UncertainPose> edge = uncertain_pose(*step.edge);
    if (!edge) return tl::make_unexpected(edge.error());
    node.depth = above.depth + 1;
    node.T_root_pose = above.T_root_pose * step.T_parent_pose();
    // The noise of an edge sits at its second pose, here the upper end if the edge points upwards.
    const bool points_down = step.edge->keys()[1].index == step.pose;
    node.covariance_in_root =
        above.covariance_in_root +
        transport_covariance(points_down ? node.T_root_pose : above.T_root_pose, edge->covariance);
    const Node& jump = tree.nodes_[above.jump];
    const bool is_even = above.depth - jump.depth == jump.depth - tree.nodes_[jump.jump].depth;
    node.jump = is_even ? jump.jump : parent;
  }
  return tree;
}

std::uint32_t OdometryTree::common_ancestor(std::uint32_t a, std::uint32_t b) const {
  if (nodes_[a].depth < nodes_[b].depth) std::swap(a, b);
  while (nodes_[a].depth > nodes_[b].depth) {
    const std::uint32_t jump = nodes_[a].jump;
    a = nodes_[jump].depth >= nodes_[b].depth ? jump : nodes_[a].parent;
  }
  while (a != b) {
    const bool do_jump = nodes_[a].jump != nodes_[b].jump;
    a = do_jump ? nodes_[a].jump : nodes_[a].parent;
    b = do_jump ? nodes_[b].jump : nodes_[b].parent;
  }
  return a;
}

UncertainPose OdometryTree::between(std::uint32_t pose_i, std::uint32_t pose_j) const {
  CORRIDOR_EXPECT(pose_i < nodes_.size() && pose_j < nodes_.size());
  const Node& i = nodes_[pose_i];
  const Node& j = nodes_[pose_j];
  const Node& meeting = nodes_[common_ancestor(pose_i, pose_j)];
  const Eigen::Matrix3d in_root =
      i.covariance_in_root + j.covariance_in_root - 2 * meeting.covariance_in_root;
  return {i.T_root_pose.between(j.T_root_pose),
          transport_covariance(j.T_root_pose.inverse(), in_root)};
}

}  // namespace corridor::backend
