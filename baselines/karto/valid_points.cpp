#include "baselines/karto/valid_points.hpp"

namespace corridor::karto {

void Surface::cut(const PointColumns& points_m, double anchor_spacing_m) {
  const double spacing2_m2 = anchor_spacing_m * anchor_spacing_m;
  for (std::vector<double>* column : {&anchor_x_m_, &anchor_y_m_, &along_x_m_, &along_y_m_}) {
    column->clear();
  }
  piece_of_point_.assign(static_cast<std::size_t>(points_m.rows()), 0);
  std::uint32_t piece = 0;
  Eigen::Index anchor = 0;
  for (Eigen::Index i = 1; i < points_m.rows(); ++i) {
    const Eigen::Vector2d along_m = points_m.row(i) - points_m.row(anchor);
    if (along_m.squaredNorm() > spacing2_m2) {
      anchor_x_m_.push_back(points_m(anchor, 0));
      anchor_y_m_.push_back(points_m(anchor, 1));
      along_x_m_.push_back(along_m.x());
      along_y_m_.push_back(along_m.y());
      ++piece;
      anchor = i;
    }
    piece_of_point_[static_cast<std::size_t>(i)] = piece;
  }
}

void Surface::find_facing(const Eigen::Vector2d& viewpoint_m,
                          std::vector<std::uint8_t>& is_facing) const {
  const std::size_t count = num_pieces();
  is_facing.resize(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double view_x_m = viewpoint_m.x() - anchor_x_m_[i];
    const double view_y_m = viewpoint_m.y() - anchor_y_m_[i];
    is_facing[i] = along_x_m_[i] * view_y_m - along_y_m_[i] * view_x_m >= 0 ? 1 : 0;
  }
  is_facing[count] = 0;
}

}  // namespace corridor::karto
