#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"

namespace corridor::backend {

Result<graph::Values> odometry_initialization(const graph::FactorGraph& graph,
                                              const graph::Values& values,
                                              std::span<const std::uint32_t> held) {
  const auto order = spanning_order(graph, values, held);
  if (!order) return tl::make_unexpected(order.error());
  graph::Values placed = values;
  for (const Placement& step : *order) {
    if (step.edge == nullptr) continue;
    const Pose2 T_map_base = placed.pose(step.parent()) * step.T_parent_pose();
    if (!T_map_base.is_finite()) {
      return fail(ErrorCode::kInvalid,
                  "the edges to " + graph::to_text(graph::pose_key(step.pose)) +
                      " add up to no finite number",
                  "odometry", "edges of a drive, in metres");
    }
    placed.set_pose(step.pose, T_map_base);
  }
  return placed;
}

}  // namespace corridor::backend
