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
// Cells by which an end point may lie beside that of the nearest coarse heading, since the fine
// search tries what is in between: at 1 cm, half a step of 2 deg at 12.6 m.
constexpr int kTurnMargin_cells = 22;
// Cells by which the search leaves its window: the lattice ends one beyond, the fine search goes
// one farther, centre and lattice are rounded.
constexpr int kLatticeMargin_cells = 4;
// Half width of headings whose circular mean is among them, with a step to spare.
constexpr double kWidestMean_rad = 1.2;
// A search of which more headings would have to be looked at may read anywhere.
constexpr double kMaxFarHeadings = 2000;
// Multiples of the coarse half width that a response expansion tries.
constexpr std::array<int, 3> kExpansions = {2, 3, 4};

int read_margin_cells(const GridSpec& spec) {
  const double half_window_cells = std::ceil(0.5 * spec.window_m / spec.resolution_m);
  return static_cast<int>(half_window_cells) + kLatticeMargin_cells + kTurnMargin_cells;
}

Pose2 moved(const Pose2& centre, const SearchOffset& offset) {
  return {centre.x_m() + offset.position_m.x(), centre.y_m() + offset.position_m.y(),
          centre.theta_rad() + offset.heading_rad};
}

}  // namespace

CorrelativeMatcher::CorrelativeMatcher(const GridSpec& spec, const KartoParams& params)
    : params_(params),
      window_m_(spec.window_m),
      edge_rule_(params.wrap_rows ? EdgeRule::kWrap : EdgeRule::kStop),
      grid_(spec, read_margin_cells(spec)) {}

MatchResult CorrelativeMatcher::match(const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                                      std::span<const KeyScan* const> local_map,
                                      const MatchOptions& options) {
  const Eigen::Vector2d centre_m = T_map_sensor_predicted.translation_m();
  const SearchAxis heading_rad = coarse_stage(params_.coarse_angle_offset_rad).heading_rad;
  grid_.reset(centre_m);
  select_beams(scan, may_give_up(options) ? kBeamStride : 1);
  aim(T_map_sensor_predicted.theta_rad(), heading_rad);
  want_cells_around_beams(T_map_sensor_predicted.theta_rad(), heading_rad);
  draw_local_map(centre_m, local_map);
  MatchResult result = coarse_search(T_map_sensor_predicted, options);
  if (options.use_refinement) result = refine(result, options.use_penalty);
  result.response = std::min(result.response, 1.0);
  return result;
}

CorrelativeMatcher::Stage CorrelativeMatcher::coarse_stage(double half_width_rad) const {
  return {{0.5 * window_m_, kCoarseStep_cells * grid_.resolution_m()},
          {half_width_rad, params_.coarse_angle_resolution_rad},
          kCoarseStep_cells};
}

CorrelativeMatcher::Stage CorrelativeMatcher::fine_stage() const {
  return {{grid_.resolution_m(), grid_.resolution_m()},
          {0.5 * params_.coarse_angle_resolution_rad, params_.fine_angle_resolution_rad},
          1};
}

void CorrelativeMatcher::select_beams(const KeyScan& scan, std::size_t stride) {
  const std::vector<Eigen::Vector2d>& beams_m = scan.beams_sensor_m();
  beams_sensor_m_.resize(static_cast<Eigen::Index>(beams_m.size()), 2);
  Eigen::Index num_finite = 0;
  std::size_t num_counted = 0;
  for (std::size_t first = 0; first < stride; ++first) {
    for (std::size_t i = first; i < beams_m.size(); i += stride) {
      if (!params_.count_no_returns && !scan.is_in_range()[i]) continue;
      ++num_counted;
      if (beams_m[i].allFinite()) beams_sensor_m_.row(num_finite++) = beams_m[i].transpose();
    }
  }
  beams_sensor_m_.conservativeResize(num_finite, 2);
  full_response_ = static_cast<double>(std::max<std::size_t>(num_counted, 1)) * kOccupied;
}

// The beams' end points at all headings of a search.
void CorrelativeMatcher::aim(double centre_rad, const SearchAxis& heading_rad) {
  num_headings_ = static_cast<std::size_t>(heading_rad.count());
  if (headings_.size() < num_headings_) headings_.resize(num_headings_);
  for (std::size_t i = 0; i < num_headings_; ++i) {
    fill_beam_offsets(beams_sensor_m_, centre_rad + heading_rad.offset(static_cast<int>(i)), grid_,
                      headings_[i].offsets);
  }
}

// Coarse and fine search read the cells around the end points of the coarse headings, and of those
// in between. A search that widens may turn anywhere, and so may the mean of tied headings that
// span half a turn.
void CorrelativeMatcher::want_cells_around_beams(double centre_rad, const SearchAxis& heading_rad) {
  GridBlocks& blocks = grid_.blocks();
  const bool may_turn_anywhere =
      params_.use_response_expansion || heading_rad.half_width > kWidestMean_rad;
  if (may_turn_anywhere || grid_.needs_all_points()) return blocks.want_all();
  for (std::size_t i = 0; i < num_headings_; ++i) want(headings_[i].offsets);
  want_cells_of_far_beams(centre_rad, heading_rad);
  blocks.add_margin();
}

// Beams so long that the margin does not cover what lies between two headings, or beyond the last;
// they have no return, but rows that wrap lead them back into the grid. Headings as close as they
// need.
void CorrelativeMatcher::want_cells_of_far_beams(double centre_rad, const SearchAxis& heading_rad) {
  const SearchAxis fine_rad = fine_stage().heading_rad;
  const double turn_rad = std::max({0.5 * heading_rad.step, std::abs(fine_rad.offset(0)),
                                    std::abs(fine_rad.offset(fine_rad.count() - 1))});
  const double far_m = kTurnMargin_cells * grid_.resolution_m() / turn_rad;
  PointColumns far_beams_m(beams_sensor_m_.rows(), 2);
  Eigen::Index num_far = 0;
  double longest_m = 0;
  for (Eigen::Index i = 0; i < beams_sensor_m_.rows(); ++i) {
    const double length_m = beams_sensor_m_.row(i).norm();
    if (length_m <= far_m) continue;
    far_beams_m.row(num_far++) = beams_sensor_m_.row(i);
    longest_m = std::max(longest_m, length_m);
  }
  if (num_far == 0) return;
  far_beams_m.conservativeResize(num_far, 2);
  const double first_rad = heading_rad.offset(0) - turn_rad;
  const double range_rad = heading_rad.offset(heading_rad.count() - 1) + turn_rad - first_rad;
  const double num_headings =
      std::ceil(range_rad * longest_m / (2 * kTurnMargin_cells * grid_.resolution_m()));
  if (num_headings > kMaxFarHeadings) return grid_.blocks().want_all();
  std::vector<BeamOffset> offsets;
  for (double i = 0.5; i < num_headings; ++i) {
    const double offset_rad = first_rad + range_rad * i / num_headings;
    fill_beam_offsets(far_beams_m, centre_rad + offset_rad, grid_, offsets);
    want(offsets);
  }
}

void CorrelativeMatcher::want(const std::vector<BeamOffset>& offsets) {
  const int middle = grid_.middle_cell();
  for (const BeamOffset& offset : offsets) {
    grid_.blocks().want(middle + offset.row, middle + offset.column);
  }
}

void CorrelativeMatcher::draw_local_map(const Eigen::Vector2d& viewpoint_m,
                                        std::span<const KeyScan* const> local_map) {
  for (const KeyScan* scan : local_map) {
    grid_.find_cells(scan->points_map_m(), cells_);
    for (const SurfacePiece& piece : scan->surface_map()) {
      if (!piece.faces(viewpoint_m)) continue;
      grid_.occupy(cells_, piece.begin, piece.end);
    }
  }
}

MatchResult CorrelativeMatcher::coarse_search(const Pose2& centre, const MatchOptions& options) {
  const double half_width_rad = params_.coarse_angle_offset_rad;
  MatchResult result = search_coarse_once(centre, coarse_stage(half_width_rad), options);
  if (!params_.use_response_expansion) return result;
  for (const int multiple : kExpansions) {
    if (result.response > kNoResponse) break;
    const Stage wider = coarse_stage(multiple * half_width_rad);
    aim(centre.theta_rad(), wider.heading_rad);
    result = search_coarse_once(centre, wider, options);
  }
  return result;
}

// Requires headings aimed.
MatchResult CorrelativeMatcher::search_coarse_once(const Pose2& centre, const Stage& stage,
                                                   const MatchOptions& options) {
  MatchResult result;
  sweep_stage(centre, stage, min_sum(options));
  if (min_sum(options) > 0) {
    result.response = best_unpenalised_response();
    if (result.response <= options.min_response) return result;
  }
  const ResponseTable table = responses(stage, options.use_penalty);
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map.topLeftCorner<2, 2>() = positional_covariance(table, result.response, best);
  result.covariance_map(2, 2) = 4 * stage.heading_rad.step * stage.heading_rad.step;
  return result;
}

// Refinement may raise a response, and a widened search has to know that there was none at all.
bool CorrelativeMatcher::may_give_up(const MatchOptions& options) const {
  return !options.use_refinement && !params_.use_response_expansion &&
         options.min_response > kResponseMargin;
}

// Everything that shapes the covariance of a match that is taken must be exact.
std::uint32_t CorrelativeMatcher::min_sum(const MatchOptions& options) const {
  if (!may_give_up(options)) return 0;
  return static_cast<std::uint32_t>((options.min_response - kResponseMargin) * full_response_);
}

MatchResult CorrelativeMatcher::refine(const MatchResult& coarse, bool use_penalty) {
  const Stage stage = fine_stage();
  const Pose2 centre = coarse.T_map_sensor;
  aim(centre.theta_rad(), stage.heading_rad);
  sweep_stage(centre, stage, 0);
  const ResponseTable table = responses(stage, use_penalty);
  MatchResult result = coarse;
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map(2, 2) =
      variance_of_heading(centre, stage.heading_rad, best, result.response);
  return result;
}

void CorrelativeMatcher::sweep_stage(const Pose2& centre, const Stage& stage,
                                     std::uint32_t min_sum) {
  const Eigen::Vector2i first =
      grid_.cell_of(centre.translation_m() + Eigen::Vector2d::Constant(stage.position_m.offset(0)));
  sweep({first.x(), first.y(), stage.step_cells, stage.position_m.count()}, min_sum);
}

void CorrelativeMatcher::sweep(const SweepWindow& window, std::uint32_t min_sum) {
  const std::size_t num_positions = window.num_positions();
  sums_.resize(num_headings_ * num_positions);
  const std::span<HeadingSweep> headings = std::span(headings_).first(num_headings_);
  for (std::size_t i = 0; i < num_headings_; ++i) {
    headings[i].sums = std::span(sums_).subspan(i * num_positions, num_positions);
  }
  sweep_window(grid_, window, edge_rule_, min_sum, headings);
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
  sweep({cell.x(), cell.y(), 1, 1}, 0);
  std::vector<double> responses;
  for (const std::uint32_t sum : sums_) responses.push_back(sum / full_response_);
  const double coarse_rad = params_.coarse_angle_resolution_rad;
  return heading_variance(responses, heading_rad, best_response, best.heading_rad,
                          4 * coarse_rad * coarse_rad);
}

}  // namespace corridor::karto
