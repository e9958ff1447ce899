#include "baselines/karto/correlative_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "baselines/karto/valid_points.hpp"

namespace corridor::karto {
namespace {

constexpr int kCoarseStep_cells = 2;
constexpr double kPenaltyGain = 0.2;
constexpr double kNoResponse = 1e-6;
// Multiples of the coarse half width that a response expansion tries.
constexpr std::array<int, 3> kExpansions = {2, 3, 4};

Pose2 moved(const Pose2& centre, const SearchOffset& offset) {
  return {centre.x_m() + offset.position_m.x(), centre.y_m() + offset.position_m.y(),
          centre.theta_rad() + offset.heading_rad};
}

}  // namespace

CorrelativeMatcher::CorrelativeMatcher(const GridSpec& spec, const KartoParams& params)
    : params_(params),
      window_m_(spec.window_m),
      edge_rule_(params.wrap_rows ? EdgeRule::kWrap : EdgeRule::kStop),
      grid_(spec) {}

MatchResult CorrelativeMatcher::match(const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                                      std::span<const KeyScan* const> local_map,
                                      const MatchOptions& options) {
  grid_.reset(T_map_sensor_predicted.translation_m());
  draw_local_map(T_map_sensor_predicted.translation_m(), local_map);
  select_beams(scan);
  MatchResult result = coarse_search(T_map_sensor_predicted, options.use_penalty);
  if (options.use_refinement) result = refine(result, options.use_penalty);
  result.response = std::min(result.response, 1.0);
  return result;
}

void CorrelativeMatcher::draw_local_map(const Eigen::Vector2d& viewpoint_m,
                                        std::span<const KeyScan* const> local_map) {
  facing_points_m_.clear();
  for (const KeyScan* scan : local_map) {
    append_points_facing(viewpoint_m, scan->points_map_m(), kAnchorSpacing_m, facing_points_m_);
  }
  grid_.add_points(facing_points_m_);
}

void CorrelativeMatcher::select_beams(const KeyScan& scan) {
  beams_sensor_m_.clear();
  for (std::size_t i = 0; i < scan.beams_sensor_m().size(); ++i) {
    if (params_.count_no_returns || scan.is_in_range()[i]) {
      beams_sensor_m_.push_back(scan.beams_sensor_m()[i]);
    }
  }
  full_response_ =
      static_cast<double>(std::max<std::size_t>(beams_sensor_m_.size(), 1)) * kOccupied;
}

MatchResult CorrelativeMatcher::coarse_search(const Pose2& centre, bool use_penalty) {
  const double half_width_rad = params_.coarse_angle_offset_rad;
  MatchResult result = search_coarse_once(centre, half_width_rad, use_penalty);
  if (!params_.use_response_expansion) return result;
  for (const int multiple : kExpansions) {
    if (result.response > kNoResponse) break;
    result = search_coarse_once(centre, multiple * half_width_rad, use_penalty);
  }
  return result;
}

MatchResult CorrelativeMatcher::search_coarse_once(const Pose2& centre, double half_width_rad,
                                                   bool use_penalty) {
  const double resolution_rad = params_.coarse_angle_resolution_rad;
  const Stage stage{{0.5 * window_m_, kCoarseStep_cells * grid_.resolution_m()},
                    {half_width_rad, resolution_rad},
                    kCoarseStep_cells};
  const ResponseTable table = respond(centre, stage, use_penalty);
  MatchResult result;
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map.topLeftCorner<2, 2>() = positional_covariance(table, result.response, best);
  result.covariance_map(2, 2) = 4 * resolution_rad * resolution_rad;
  return result;
}

MatchResult CorrelativeMatcher::refine(const MatchResult& coarse, bool use_penalty) {
  const Stage stage{{grid_.resolution_m(), grid_.resolution_m()},
                    {0.5 * params_.coarse_angle_resolution_rad, params_.fine_angle_resolution_rad},
                    1};
  const Pose2 centre = coarse.T_map_sensor;
  const ResponseTable table = respond(centre, stage, use_penalty);
  MatchResult result = coarse;
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map(2, 2) =
      variance_of_heading(centre, stage.heading_rad, best, result.response);
  return result;
}

ResponseTable CorrelativeMatcher::respond(const Pose2& centre, const Stage& stage,
                                          bool use_penalty) {
  ResponseTable table(stage.position_m, stage.heading_rad);
  const Eigen::Vector2i first =
      grid_.cell_of(centre.translation_m() + Eigen::Vector2d::Constant(stage.position_m.offset(0)));
  const SweepWindow window{first.x(), first.y(), stage.step_cells, table.num_positions()};
  for (int heading = 0; heading < table.num_headings(); ++heading) {
    fill_beam_offsets(beams_sensor_m_, centre.theta_rad() + stage.heading_rad.offset(heading),
                      grid_, offsets_);
    sweep_window(grid_, offsets_, window, edge_rule_, sums_);
    double* responses = table.row(heading, 0);
    for (std::size_t i = 0; i < sums_.size(); ++i) responses[i] = sums_[i] / full_response_;
  }
  if (use_penalty) apply_penalty(table);
  return table;
}

void CorrelativeMatcher::apply_penalty(ResponseTable& table) const {
  for (int heading = 0; heading < table.num_headings(); ++heading) {
    const double a_rad = table.heading_rad().offset(heading);
    const double angle_penalty =
        std::max(params_.min_angle_penalty,
                 1 - kPenaltyGain * a_rad * a_rad / params_.angle_variance_penalty_rad2);
    for (int y = 0; y < table.num_positions(); ++y) {
      const double y_m = table.position_m().offset(y);
      for (int x = 0; x < table.num_positions(); ++x) {
        const double x_m = table.position_m().offset(x);
        const double distance2_m2 = x_m * x_m + y_m * y_m;
        const double distance_penalty =
            std::max(params_.min_distance_penalty,
                     1 - kPenaltyGain * distance2_m2 / params_.distance_variance_penalty_m2);
        table.at(heading, y, x) *= distance_penalty * angle_penalty;
      }
    }
  }
}

double CorrelativeMatcher::variance_of_heading(const Pose2& centre, const SearchAxis& heading_rad,
                                               const SearchOffset& best, double best_response) {
  const Eigen::Vector2i cell = grid_.cell_of(centre.translation_m() + best.position_m);
  const SweepWindow window{cell.x(), cell.y(), 1, 1};
  std::vector<double> responses;
  for (int heading = 0; heading < heading_rad.count(); ++heading) {
    fill_beam_offsets(beams_sensor_m_, centre.theta_rad() + heading_rad.offset(heading), grid_,
                      offsets_);
    sweep_window(grid_, offsets_, window, edge_rule_, sums_);
    responses.push_back(sums_.front() / full_response_);
  }
  const double coarse_rad = params_.coarse_angle_resolution_rad;
  return heading_variance(responses, heading_rad, best_response, best.heading_rad,
                          4 * coarse_rad * coarse_rad);
}

}  // namespace corridor::karto
