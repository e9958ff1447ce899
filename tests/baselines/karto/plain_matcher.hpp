// The matcher by its definition: the whole grid is cleared and drawn for every match, cell by cell,
// and every pose of a window is tried for itself, beam by beam. Nothing is left out and nothing is
// kept. It shares with the program's matcher only what is rounded or smeared by rule (rounding, the
// kernel, the parameters) and what follows from a table of responses.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "baselines/karto/response_table.hpp"
#include "baselines/karto/round_cells.hpp"
#include "baselines/karto/scan_matcher.hpp"
#include "baselines/karto/smear_kernel.hpp"

namespace corridor::karto::testing {

class PlainMatcher {
 public:
  PlainMatcher(const GridSpec& spec, const KartoParams& params)
      : spec_(spec),
        params_(params),
        kernel_(spec.smear_m, spec.resolution_m),
        border_(kernel_.half_width + 1),
        side_(spec.inner_side_cells() + 2 * border_),
        stride_((side_ + 7) / 8 * 8) {}

  MatchResult match(const KeyScan& scan, const Pose2& predicted,
                    std::span<const KeyScan* const> local_map, const MatchOptions& options) {
    corner_m_ = predicted.translation_m() -
                Eigen::Vector2d::Constant(0.5 * (side_ - 1) * spec_.resolution_m);
    draw(predicted.translation_m(), local_map);
    scan_ = &scan;
    const double half_rad = params_.coarse_angle_offset_rad;
    MatchResult result = coarse(predicted, half_rad, options.use_penalty);
    for (const int multiple : {2, 3, 4}) {
      if (!params_.use_response_expansion || result.response > 1e-6) break;
      result = coarse(predicted, multiple * half_rad, options.use_penalty);
    }
    if (options.use_refinement) result = fine(result, options.use_penalty);
    result.response = std::min(result.response, 1.0);
    return result;
  }

 private:
  [[nodiscard]] int cell(double coordinate_m, double corner_m) const {
    return round_to_cell((coordinate_m - corner_m) / spec_.resolution_m);
  }

  void draw(const Eigen::Vector2d& viewpoint_m, std::span<const KeyScan* const> local_map) {
    grid_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(stride_), 0);
    for (const KeyScan* scan : local_map) {
      const PointColumns& points_m = scan->points_map_m();
      Eigen::Index anchor = 0;
      for (Eigen::Index i = 1; i < points_m.rows(); ++i) {
        const Eigen::Vector2d from_m = points_m.row(anchor);
        const Eigen::Vector2d along_m = points_m.row(i).transpose() - from_m;
        if (!(along_m.squaredNorm() > kAnchorSpacing_m * kAnchorSpacing_m)) continue;
        const Eigen::Vector2d view_m = viewpoint_m - from_m;
        if (along_m.x() * view_m.y() - along_m.y() * view_m.x() >= 0) {
          for (Eigen::Index k = anchor; k < i; ++k) stamp(points_m(k, 0), points_m(k, 1));
        }
        anchor = i;
      }
    }
  }

  void stamp(double x_m, double y_m) {
    const int column = cell(x_m, corner_m_.x());
    const int row = cell(y_m, corner_m_.y());
    if (std::min(column, row) < border_ || std::max(column, row) >= side_ - border_) return;
    // The original's rule: what is occupied, be it by another's stamp, is not stamped again.
    if (grid_[static_cast<std::size_t>(row * stride_ + column)] == kOccupied) return;
    const int reach = kernel_.half_width;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        std::uint8_t& value = grid_[static_cast<std::size_t>((row + dy) * stride_ + column + dx)];
        value = std::max(value, kernel_.at(dx, dy));
      }
    }
  }

  // Response of one pose: a cell for the position, a rotation for the beams.
  [[nodiscard]] double response(const Eigen::Vector2i& position, double heading_rad) const {
    const double cells_per_m = 1 / spec_.resolution_m;
    const double c = std::cos(heading_rad) * cells_per_m;
    const double s = std::sin(heading_rad) * cells_per_m;
    std::uint32_t sum = 0;
    int num_beams = 0;
    for (std::size_t i = 0; i < scan_->beams_sensor_m().size(); ++i) {
      if (!params_.count_no_returns && scan_->is_in_range()[i] == 0) continue;
      ++num_beams;
      const Eigen::Vector2d beam_m = scan_->beams_sensor_m()[i];
      if (!beam_m.allFinite()) continue;
      const std::int64_t column =
          position.x() + round_to_cell(std::fma(c, beam_m.x(), -(s * beam_m.y())));
      const std::int64_t row =
          position.y() + round_to_cell(std::fma(s, beam_m.x(), c * beam_m.y()));
      if (!params_.wrap_rows && (column < 0 || column >= side_)) continue;
      const std::int64_t index = column + row * stride_;
      if (index >= 0 && index < static_cast<std::int64_t>(grid_.size())) {
        sum += grid_[static_cast<std::size_t>(index)];
      }
    }
    return sum / (100.0 * std::max(num_beams, 1));
  }

  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& point_m) const {
    return {cell(point_m.x(), corner_m_.x()), cell(point_m.y(), corner_m_.y())};
  }

  [[nodiscard]] ResponseTable search(const Pose2& centre, const SearchAxis& position_m,
                                     int step_cells, const SearchAxis& heading_rad,
                                     bool use_penalty) const {
    ResponseTable table(position_m, heading_rad);
    const Eigen::Vector2i first =
        cell_of(centre.translation_m() + Eigen::Vector2d::Constant(position_m.offset(0)));
    for (int heading = 0; heading < table.num_headings(); ++heading) {
      for (int y = 0; y < table.num_positions(); ++y) {
        for (int x = 0; x < table.num_positions(); ++x) {
          const double a_rad = heading_rad.offset(heading);
          table.at(heading, y, x) =
              response(first + step_cells * Eigen::Vector2i(x, y), centre.theta_rad() + a_rad);
          if (!use_penalty) continue;
          const double x_m = position_m.offset(x);
          const double y_m = position_m.offset(y);
          table.at(heading, y, x) *=
              std::max(params_.min_distance_penalty,
                       1 - 0.2 * (x_m * x_m + y_m * y_m) / params_.distance_variance_penalty_m2) *
              std::max(params_.min_angle_penalty,
                       1 - 0.2 * a_rad * a_rad / params_.angle_variance_penalty_rad2);
        }
      }
    }
    return table;
  }

  [[nodiscard]] static Pose2 moved(const Pose2& centre, const SearchOffset& offset) {
    return {centre.x_m() + offset.position_m.x(), centre.y_m() + offset.position_m.y(),
            centre.theta_rad() + offset.heading_rad};
  }

  [[nodiscard]] MatchResult coarse(const Pose2& centre, double half_width_rad,
                                   bool use_penalty) const {
    const double step_rad = params_.coarse_angle_resolution_rad;
    const ResponseTable table = search(centre, {0.5 * spec_.window_m, 2 * spec_.resolution_m}, 2,
                                       {half_width_rad, step_rad}, use_penalty);
    MatchResult result;
    result.response = table.best_response();
    const SearchOffset best = mean_best_offset(table, result.response);
    result.T_map_sensor = moved(centre, best);
    result.covariance_map.topLeftCorner<2, 2>() =
        positional_covariance(table, result.response, best);
    result.covariance_map(2, 2) = 4 * step_rad * step_rad;
    return result;
  }

  [[nodiscard]] MatchResult fine(const MatchResult& coarse, bool use_penalty) const {
    const Pose2 centre = coarse.T_map_sensor;
    const double coarse_step_rad = params_.coarse_angle_resolution_rad;
    const SearchAxis heading_rad{0.5 * coarse_step_rad, params_.fine_angle_resolution_rad};
    const ResponseTable table =
        search(centre, {spec_.resolution_m, spec_.resolution_m}, 1, heading_rad, use_penalty);
    MatchResult result = coarse;
    result.response = table.best_response();
    const SearchOffset best = mean_best_offset(table, result.response);
    result.T_map_sensor = moved(centre, best);
    std::vector<double> responses;
    for (int i = 0; i < heading_rad.count(); ++i) {
      responses.push_back(response(cell_of(centre.translation_m() + best.position_m),
                                   centre.theta_rad() + heading_rad.offset(i)));
    }
    result.covariance_map(2, 2) =
        heading_variance(responses, heading_rad, result.response, best.heading_rad,
                         4 * coarse_step_rad * coarse_step_rad);
    return result;
  }

  GridSpec spec_;
  KartoParams params_;
  SmearKernel kernel_;
  int border_;
  int side_;
  int stride_;
  Eigen::Vector2d corner_m_ = Eigen::Vector2d::Zero();
  std::vector<std::uint8_t> grid_;
  const KeyScan* scan_ = nullptr;
};

}  // namespace corridor::karto::testing
