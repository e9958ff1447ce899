#include "baselines/karto/valid_points.hpp"

namespace corridor::karto {

void cut_surface(const PointColumns& points_m, double anchor_spacing_m,
                 std::vector<SurfacePiece>& pieces) {
  const double spacing2_m2 = anchor_spacing_m * anchor_spacing_m;
  pieces.clear();
  std::uint32_t anchor = 0;
  for (std::uint32_t i = 1; i < points_m.rows(); ++i) {
    const Eigen::Vector2d anchor_m = points_m.row(anchor);
    const Eigen::Vector2d along_m = points_m.row(i).transpose() - anchor_m;
    if (!(along_m.squaredNorm() > spacing2_m2)) continue;
    pieces.push_back({anchor, i, anchor_m, along_m});
    anchor = i;
  }
}

}  // namespace corridor::karto
