#include "baselines/karto/valid_points.hpp"

namespace corridor::karto {

void append_points_facing(const Eigen::Vector2d& viewpoint_map_m,
                          std::span<const Eigen::Vector2d> points_map_m, double anchor_spacing_m,
                          std::vector<Eigen::Vector2d>& kept_map_m) {
  const double spacing2_m2 = anchor_spacing_m * anchor_spacing_m;
  std::size_t anchor_index = 0;
  for (std::size_t i = 1; i < points_map_m.size(); ++i) {
    const Eigen::Vector2d& anchor_m = points_map_m[anchor_index];
    const Eigen::Vector2d along_m = points_map_m[i] - anchor_m;
    if (!(along_m.squaredNorm() > spacing2_m2)) continue;
    const Eigen::Vector2d view_m = viewpoint_map_m - anchor_m;
    const double side_m2 = along_m.x() * view_m.y() - along_m.y() * view_m.x();
    if (side_m2 >= 0) {
      const auto lagging = points_map_m.subspan(anchor_index, i - anchor_index);
      kept_map_m.insert(kept_map_m.end(), lagging.begin(), lagging.end());
    }
    anchor_index = i;
  }
}

}  // namespace corridor::karto
