// Keeps the end points of a scan whose surface is seen from its front at another viewpoint.
// It does not know what hides a surface, only on which side of it the viewpoint lies.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace corridor::karto {

// n x 2: one point a row, (x, y) [m]; each coordinate is contiguous.
using PointColumns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

// Points [begin, end) of a scan, from one anchor up to the next. The line between the two is a
// piece of surface whose front is on its left, where the sensor was.
struct SurfacePiece {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  Eigen::Vector2d anchor_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d along_m = Eigen::Vector2d::Zero();  // to the next anchor

  // True if the viewpoint, in the frame of the points, is on the piece's front or in its line.
  [[nodiscard]] bool faces(const Eigen::Vector2d& viewpoint_m) const {
    const Eigen::Vector2d view_m = viewpoint_m - anchor_m;
    return along_m.x() * view_m.y() - along_m.y() * view_m.x() >= 0;
  }
};

// Cuts a scan's points, in order of the beams (counter-clockwise), into pieces: the first point is
// an anchor, and so is each that lies more than `anchor_spacing_m` from the last one. The points
// from the last anchor on belong to no piece. The valid points of the scan for a viewpoint are
// those of the pieces that face it.
void cut_surface(const PointColumns& points_m, double anchor_spacing_m,
                 std::vector<SurfacePiece>& pieces);

// Spacing as shipped.
inline constexpr double kAnchorSpacing_m = 0.1;

}  // namespace corridor::karto
