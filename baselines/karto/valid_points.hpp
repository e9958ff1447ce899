// Which end points of a scan to keep: those whose surface is seen from its front at another
// viewpoint. It does not know what hides a surface, only on which side of it the viewpoint lies.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace corridor::karto {

// n x 2: one point a row, (x, y) [m]; each coordinate is contiguous.
using PointColumns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

// A scan's points, in order of the beams (counter-clockwise), cut into pieces of surface: from one
// anchor up to the next. The line between the two has its front on its left, where the sensor was.
// Each attribute is contiguous, so that several pieces are judged at once.
class Surface {
 public:
  // The first point is an anchor, and so is each that lies more than `anchor_spacing_m` from the
  // last one. The points from the last anchor on belong to no piece.
  void cut(const PointColumns& points_m, double anchor_spacing_m);

  [[nodiscard]] std::size_t num_pieces() const { return along_x_m_.size(); }
  // One a point; num_pieces() for those that belong to none.
  [[nodiscard]] const std::vector<std::uint32_t>& piece_of_point() const { return piece_of_point_; }
  // is_facing[piece] = 1 if the viewpoint, in the frame of the points, is on the piece's front or
  // in its line; is_facing[num_pieces()] = 0. The valid points of the scan are those of the pieces
  // that face the viewpoint.
  void find_facing(const Eigen::Vector2d& viewpoint_m, std::vector<std::uint8_t>& is_facing) const;

 private:
  std::vector<double> anchor_x_m_;
  std::vector<double> anchor_y_m_;
  std::vector<double> along_x_m_;  // to the next anchor
  std::vector<double> along_y_m_;
  std::vector<std::uint32_t> piece_of_point_;
};

// Spacing as shipped.
inline constexpr double kAnchorSpacing_m = 0.1;

}  // namespace corridor::karto
