// Finds a pose by trying all of a window [Olson2009]: for each rotation the points are laid over a
// smeared image of the map's surfaces at every shift. Coarse on purpose: scan_matcher refines.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::matching {

struct CorrelativeParams {
  double resolution_m = 0.1;
  double smear_m = 0.15;  // a point this far from a surface still scores exp(-1/2)
  double angle_step_rad = 0.03;

  template <class V>
  static void visit(CorrelativeParams& p, V&& v) {
    v(ParamInfo{"search_resolution_m", "m", "side of a cell and step of the search", 0.01, 1},
      p.resolution_m);
    v(ParamInfo{"search_smear_m", "m", "width of a surface in the image", 0.01, 2}, p.smear_m);
    v(ParamInfo{"search_angle_step_rad", "rad", "step of the search", 0.001, 0.5},
      p.angle_step_rad);
  }
};

// Byte image of how near each place is to a surface: 255 exp(-d^2 / (2 smear^2)).
class SurfaceImage {
 public:
  SurfaceImage(std::span<const Eigen::Vector2d> surface_points_m, const CorrelativeParams& params);

  // 0 outside. cell = floor((point - origin) / resolution).
  [[nodiscard]] std::uint8_t at(int column, int row) const {
    return column < 0 || row < 0 || column >= num_columns_ || row >= num_rows_
               ? std::uint8_t{0}
               : cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
                        static_cast<std::size_t>(column)];
  }
  [[nodiscard]] const Eigen::Vector2d& origin_m() const { return origin_m_; }
  [[nodiscard]] double resolution_m() const { return resolution_m_; }

 private:
  double resolution_m_;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<std::uint8_t> cells_;
};

struct CorrelativeResult {
  Pose2 T_map_base;
  double score = 0;  // mean over the points, 0 to 1
};

// The best pose within +-window_m in x and y and +-window_rad of the centre. Ties go to the
// nearest.
CorrelativeResult search(const SurfaceImage& image, std::span<const Eigen::Vector2d> points_base_m,
                         const Pose2& T_map_base_centre, double window_m, double window_rad,
                         const CorrelativeParams& params);

}  // namespace corridor::matching
