// Keeps the end points of a scan whose surface is seen from its front at another viewpoint.
// It does not know what hides a surface, only on which side of it the viewpoint lies.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace corridor::karto {

// Appends the kept points to `kept_map_m`. Points are walked in order of the beams
// (counter-clockwise). Whenever a point lies more than `anchor_spacing_m` from the last anchor, the
// line anchor -> point is a piece of surface whose front is on its left, where the sensor was: the
// points since the anchor are kept if the viewpoint is on the left or on the line, dropped
// otherwise, and the point becomes the anchor. The points from the last anchor on are never kept.
void append_points_facing(const Eigen::Vector2d& viewpoint_map_m,
                          std::span<const Eigen::Vector2d> points_map_m, double anchor_spacing_m,
                          std::vector<Eigen::Vector2d>& kept_map_m);

// Spacing as shipped.
inline constexpr double kAnchorSpacing_m = 0.1;

}  // namespace corridor::karto
