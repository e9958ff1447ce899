#include "baselines/karto/correlative_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace corridor::karto {
namespace {

constexpr int kCoarseStep_cells = 2;
constexpr double kPenaltyGain = 0.2;
constexpr double kNoResponse = 1e-6;
// Neighbouring beams mostly find or miss the same surface. Taken in this stride, the first few say
// more about the rest.
constexpr std::size_t kBeamStride = 8;
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
  MatchResult result = coarse_search(T_map_sensor_predicted, options);
  if (options.use_refinement) result = refine(result, options.use_penalty);
  result.response = std::min(result.response, 1.0);
  return result;
}

void CorrelativeMatcher::draw_local_map(const Eigen::Vector2d& viewpoint_m,
                                        std::span<const KeyScan* const> local_map) {
  for (const KeyScan* scan : local_map) {
    grid_.find_cells(scan->points_map_m(), cells_);
    for (const SurfacePiece& piece : scan->surface_map()) {
      if (!piece.faces(viewpoint_m)) continue;
      grid_.occupy(std::span(cells_).subspan(piece.begin, piece.end - piece.begin));
    }
  }
}

void CorrelativeMatcher::select_beams(const KeyScan& scan) {
  const std::vector<Eigen::Vector2d>& beams_m = scan.beams_sensor_m();
  beams_sensor_m_.resize(static_cast<Eigen::Index>(beams_m.size()), 2);
  Eigen::Index num_finite = 0;
  std::size_t num_counted = 0;
  for (std::size_t first = 0; first < kBeamStride; ++first) {
    for (std::size_t i = first; i < beams_m.size(); i += kBeamStride) {
      if (!params_.count_no_returns && !scan.is_in_range()[i]) continue;
      ++num_counted;
      if (beams_m[i].allFinite()) beams_sensor_m_.row(num_finite++) = beams_m[i].transpose();
    }
  }
  beams_sensor_m_.conservativeResize(num_finite, 2);
  full_response_ = static_cast<double>(std::max<std::size_t>(num_counted, 1)) * kOccupied;
}

MatchResult CorrelativeMatcher::coarse_search(const Pose2& centre, const MatchOptions& options) {
  const double half_width_rad = params_.coarse_angle_offset_rad;
  MatchResult result = search_coarse_once(centre, half_width_rad, options);
  if (!params_.use_response_expansion) return result;
  for (const int multiple : kExpansions) {
    if (result.response > kNoResponse) break;
    result = search_coarse_once(centre, multiple * half_width_rad, options);
  }
  return result;
}

MatchResult CorrelativeMatcher::search_coarse_once(const Pose2& centre, double half_width_rad,
                                                   const MatchOptions& options) {
  const double resolution_rad = params_.coarse_angle_resolution_rad;
  const Stage stage{{0.5 * window_m_, kCoarseStep_cells * grid_.resolution_m()},
                    {half_width_rad, resolution_rad},
                    kCoarseStep_cells};
  MatchResult result;
  sum_up(centre, stage, min_sum(options));
  if (min_sum(options) > 0) {
    result.response = best_unpenalised_response();
    if (result.response <= options.min_response) return result;
  }
  const ResponseTable table = responses(stage, options.use_penalty);
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map.topLeftCorner<2, 2>() = positional_covariance(table, result.response, best);
  result.covariance_map(2, 2) = 4 * resolution_rad * resolution_rad;
  return result;
}

// Everything that shapes the covariance of a match that is taken must be exact. A widened search
// has to know that there was no response at all, and refinement may raise it.
std::uint32_t CorrelativeMatcher::min_sum(const MatchOptions& options) const {
  if (options.use_refinement || params_.use_response_expansion) return 0;
  const double needed = (options.min_response - kResponseMargin) * full_response_;
  return static_cast<std::uint32_t>(std::max(needed - 1, 0.0));
}

MatchResult CorrelativeMatcher::refine(const MatchResult& coarse, bool use_penalty) {
  const Stage stage{{grid_.resolution_m(), grid_.resolution_m()},
                    {0.5 * params_.coarse_angle_resolution_rad, params_.fine_angle_resolution_rad},
                    1};
  const Pose2 centre = coarse.T_map_sensor;
  sum_up(centre, stage, 0);
  const ResponseTable table = responses(stage, use_penalty);
  MatchResult result = coarse;
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map(2, 2) =
      variance_of_heading(centre, stage.heading_rad, best, result.response);
  return result;
}

void CorrelativeMatcher::sum_up(const Pose2& centre, const Stage& stage, std::uint32_t min_sum) {
  const Eigen::Vector2i first =
      grid_.cell_of(centre.translation_m() + Eigen::Vector2d::Constant(stage.position_m.offset(0)));
  const SweepWindow window{first.x(), first.y(), stage.step_cells, stage.position_m.count()};
  const auto num_headings = static_cast<std::size_t>(stage.heading_rad.count());
  if (headings_.size() < num_headings) headings_.resize(num_headings);
  sums_.resize(num_headings * window.num_positions());
  for (std::size_t i = 0; i < num_headings; ++i) {
    Heading& heading = headings_[i];
    const double offset_rad = stage.heading_rad.offset(static_cast<int>(i));
    fill_beam_offsets(beams_sensor_m_, centre.theta_rad() + offset_rad, grid_, heading.offsets);
    heading.sweep.run(grid_, heading.offsets, window, edge_rule_, min_sum,
                      std::span(sums_).subspan(i * window.num_positions(), window.num_positions()));
  }
}

double CorrelativeMatcher::best_unpenalised_response() const {
  return *std::max_element(sums_.begin(), sums_.end()) / full_response_;
}

ResponseTable CorrelativeMatcher::responses(const Stage& stage, bool use_penalty) const {
  ResponseTable table(stage.position_m, stage.heading_rad);
  const std::span<double> responses = table.responses();
  for (std::size_t i = 0; i < responses.size(); ++i) responses[i] = sums_[i] / full_response_;
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

// The beams' offsets are those of the fine search, which has just tried the same headings.
double CorrelativeMatcher::variance_of_heading(const Pose2& centre, const SearchAxis& heading_rad,
                                               const SearchOffset& best, double best_response) {
  const Eigen::Vector2i cell = grid_.cell_of(centre.translation_m() + best.position_m);
  const SweepWindow window{cell.x(), cell.y(), 1, 1};
  std::vector<double> responses;
  for (int i = 0; i < heading_rad.count(); ++i) {
    Heading& heading = headings_[static_cast<std::size_t>(i)];
    std::uint32_t sum = 0;
    heading.sweep.run(grid_, heading.offsets, window, edge_rule_, 0, {&sum, 1});
    responses.push_back(sum / full_response_);
  }
  const double coarse_rad = params_.coarse_angle_resolution_rad;
  return heading_variance(responses, heading_rad, best_response, best.heading_rad,
                          4 * coarse_rad * coarse_rad);
}

}  // namespace corridor::karto
