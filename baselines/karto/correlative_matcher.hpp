// Correlative scan-to-local-map matching in two stages, coarse and fine.
// [Konolige2010] section IV, [Olson2009]; as shipped by Karto. It searches a fixed window by brute
// force; it has no branch and bound and no gradient.
#pragma once

#include <span>
#include <vector>

#include "baselines/karto/correlation_grid.hpp"
#include "baselines/karto/karto_params.hpp"
#include "baselines/karto/key_scan.hpp"
#include "baselines/karto/response_table.hpp"
#include "baselines/karto/window_sweep.hpp"

namespace corridor::karto {

struct MatchOptions {
  bool use_penalty = false;    // prefer poses near the prediction
  bool use_refinement = true;  // fine stage after the coarse one
};

struct MatchResult {
  Pose2 T_map_sensor;
  // 3x3, order (x_m, y_m, theta_rad): position in map axes, heading.
  Eigen::Matrix3d covariance_map = Eigen::Matrix3d::Zero();
  double response = 0;  // 0 to 1: share of beams that end on a surface of the local map
};

class CorrelativeMatcher {
 public:
  CorrelativeMatcher(const GridSpec& spec, const KartoParams& params);

  // Finds the scan's pose against the end points of `local_map`, within the window around
  // `T_map_sensor_predicted`. Only surfaces facing the predicted position count.
  MatchResult match(const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                    std::span<const KeyScan* const> local_map, const MatchOptions& options);

 private:
  struct Stage {
    SearchAxis position_m;
    SearchAxis heading_rad;
    int step_cells;
  };

  void draw_local_map(const Eigen::Vector2d& viewpoint_m,
                      std::span<const KeyScan* const> local_map);
  void select_beams(const KeyScan& scan);
  MatchResult coarse_search(const Pose2& centre, bool use_penalty);
  MatchResult search_coarse_once(const Pose2& centre, double half_width_rad, bool use_penalty);
  MatchResult refine(const MatchResult& coarse, bool use_penalty);
  ResponseTable respond(const Pose2& centre, const Stage& stage, bool use_penalty);
  void apply_penalty(ResponseTable& table) const;
  double variance_of_heading(const Pose2& centre, const SearchAxis& heading_rad,
                             const SearchOffset& best, double best_response);

  KartoParams params_;
  double window_m_;
  EdgeRule edge_rule_;
  CorrelationGrid grid_;
  std::vector<Eigen::Vector2d> facing_points_m_;
  std::vector<Eigen::Vector2d> beams_sensor_m_;
  double full_response_ = 1;  // sum that would be a response of 1
  std::vector<BeamOffset> offsets_;
  std::vector<std::uint32_t> sums_;
};

}  // namespace corridor::karto
