#include "baselines/karto/correlative_matcher.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace corridor::karto {
namespace {

constexpr int kCoarseStep_cells = 2;
constexpr double kPenaltyGain = 0.2;
constexpr double kNoResponse = 1e-6;
// Half width of headings whose circular mean is among them, with a step to spare.
constexpr double kWidestMean_rad = 1.2;
// Fewer headings, or positions along a window, are not worth another grid.
constexpr int kMinHeadingsPerPart = 5;
constexpr int kMinPositionsForParts = 32;
// Multiples of the coarse half width that a response expansion tries.
constexpr std::array<int, 3> kExpansions = {2, 3, 4};

Pose2 moved(const Pose2& centre, const SearchOffset& offset) {
  return {centre.x_m() + offset.position_m.x(), centre.y_m() + offset.position_m.y(),
          centre.theta_rad() + offset.heading_rad};
}

}  // namespace

CorrelativeMatcher::CorrelativeMatcher(const GridSpec& spec, const KartoParams& params)
    : params_(params),
      edge_rule_(params.wrap_rows ? EdgeRule::kWrap : EdgeRule::kStop),
      spec_(spec) {
  parts_.emplace_back(spec);
}

MatchResult CorrelativeMatcher::match(const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                                      std::span<const KeyScan* const> local_map,
                                      const MatchOptions& options) {
  select_beams(scan);
  const Stage stage = coarse_stage(params_.coarse_angle_offset_rad);
  share_out(stage, options.use_threads);
  draw(T_map_sensor_predicted, stage.heading_rad, local_map);
  MatchResult result = coarse_search(T_map_sensor_predicted, options);
  if (options.use_refinement) {
    result = refine(T_map_sensor_predicted, result, options.use_penalty);
  }
  result.response = std::min(result.response, 1.0);
  return result;
}

CorrelativeMatcher::Stage CorrelativeMatcher::coarse_stage(double half_width_rad) const {
  return {{0.5 * spec_.window_m, kCoarseStep_cells * spec_.resolution_m},
          {half_width_rad, params_.coarse_angle_resolution_rad},
          kCoarseStep_cells};
}

CorrelativeMatcher::Stage CorrelativeMatcher::fine_stage() const {
  return {{spec_.resolution_m, spec_.resolution_m},
          {0.5 * params_.coarse_angle_resolution_rad, params_.fine_angle_resolution_rad},
          1};
}

void CorrelativeMatcher::select_beams(const KeyScan& scan) {
  const std::vector<Eigen::Vector2d>& beams_m = scan.beams_sensor_m();
  beams_sensor_m_.resize(static_cast<Eigen::Index>(beams_m.size()), 2);
  Eigen::Index num_finite = 0;
  std::size_t num_counted = 0;
  for (std::size_t i = 0; i < beams_m.size(); ++i) {
    if (!params_.count_no_returns && !scan.is_in_range()[i]) continue;
    ++num_counted;
    if (beams_m[i].allFinite()) beams_sensor_m_.row(num_finite++) = beams_m[i].transpose();
  }
  beams_sensor_m_.conservativeResize(num_finite, 2);
  full_response_ = static_cast<double>(std::max<std::size_t>(num_counted, 1)) * kOccupied;
}

void CorrelativeMatcher::share_out(const Stage& stage, bool use_threads) {
  const bool is_worth_it = use_threads && stage.position_m.count() >= kMinPositionsForParts;
  const int num_threads = is_worth_it ? tbb::this_task_arena::max_concurrency() : 1;
  num_parts_ = static_cast<std::size_t>(
      std::clamp(stage.heading_rad.count() / kMinHeadingsPerPart, 1, num_threads));
  while (parts_.size() < num_parts_) parts_.emplace_back(spec_);
}

// Each part finds the cells of some of the scans, and draws of all what its headings may read.
void CorrelativeMatcher::draw(const Pose2& centre, const SearchAxis& heading_rad,
                              std::span<const KeyScan* const> local_map) {
  for_each_part([&](SearchPart& part, std::size_t index) {
    const HeadingRange headings = headings_of_part(index, centre.theta_rad(), heading_rad);
    part.reset(centre.translation_m());
    part.aim(beams_sensor_m_, headings);
    want_cells(part, headings);
  });
  for_each_part([&](SearchPart& part, std::size_t index) {
    const std::size_t begin = local_map.size() * index / num_parts_;
    const std::size_t end = local_map.size() * (index + 1) / num_parts_;
    part.find(local_map.subspan(begin, end - begin), std::span(parts_).first(num_parts_));
  });
  for_each_part([&](SearchPart& part, std::size_t) {
    for (std::size_t i = 0; i < num_parts_; ++i) part.draw(parts_[i]);
  });
}

// A search that widens may turn anywhere, and so may the mean of tied headings that span half a
// turn.
void CorrelativeMatcher::want_cells(SearchPart& part, const HeadingRange& headings) const {
  const bool may_turn_anywhere =
      params_.use_response_expansion || headings.axis_rad.half_width > kWidestMean_rad;
  if (may_turn_anywhere || part.grid().needs_all_points()) return part.want_all();
  const SearchAxis fine_rad = fine_stage().heading_rad;
  const double turn_rad = std::max({0.5 * headings.axis_rad.step, std::abs(fine_rad.offset(0)),
                                    std::abs(fine_rad.offset(fine_rad.count() - 1))});
  part.want_around(beams_sensor_m_, headings, turn_rad);
}

HeadingRange CorrelativeMatcher::headings_of_part(std::size_t index, double centre_rad,
                                                  const SearchAxis& heading_rad) const {
  const auto num_headings = static_cast<std::size_t>(heading_rad.count());
  return {centre_rad, heading_rad, static_cast<int>(num_headings * index / num_parts_),
          static_cast<int>(num_headings * (index + 1) / num_parts_)};
}

// The part whose grid holds what is to be read around a heading: that of the nearest one tried.
SearchPart& CorrelativeMatcher::part_at(double offset_rad, const SearchAxis& heading_rad) {
  const double nearest = std::round((offset_rad - heading_rad.offset(0)) / heading_rad.step);
  for (std::size_t i = 0; i + 1 < num_parts_; ++i) {
    if (nearest < headings_of_part(i, 0, heading_rad).end) return parts_[i];
  }
  return parts_[num_parts_ - 1];
}

template <class Body>
void CorrelativeMatcher::for_each_part(const Body& body) {
  if (num_parts_ == 1) return body(parts_.front(), 0);
  tbb::parallel_for(std::size_t{0}, num_parts_, [&](std::size_t i) { body(parts_[i], i); });
}

MatchResult CorrelativeMatcher::coarse_search(const Pose2& centre, const MatchOptions& options) {
  const double half_width_rad = params_.coarse_angle_offset_rad;
  MatchResult result = search_coarse_once(centre, coarse_stage(half_width_rad), options);
  if (!params_.use_response_expansion) return result;
  for (const int multiple : kExpansions) {
    if (result.response > kNoResponse) break;
    const Stage wider = coarse_stage(multiple * half_width_rad);
    for_each_part([&](SearchPart& part, std::size_t index) {
      part.aim(beams_sensor_m_, headings_of_part(index, centre.theta_rad(), wider.heading_rad));
    });
    result = search_coarse_once(centre, wider, options);
  }
  return result;
}

// Requires parts aimed.
MatchResult CorrelativeMatcher::search_coarse_once(const Pose2& centre, const Stage& stage,
                                                   const MatchOptions& options) {
  MatchResult result;
  sweep_coarse(centre, stage, min_sum(options));
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

// The fine search has few headings, too few to be shared out.
MatchResult CorrelativeMatcher::refine(const Pose2& predicted, const MatchResult& coarse,
                                       bool use_penalty) {
  const Stage stage = fine_stage();
  const Pose2 centre = coarse.T_map_sensor;
  const SearchAxis coarse_rad = coarse_stage(params_.coarse_angle_offset_rad).heading_rad;
  SearchPart& part = part_at(predicted.between(centre).theta_rad(), coarse_rad);
  part.aim(beams_sensor_m_, HeadingRange::all(centre.theta_rad(), stage.heading_rad));
  sums_.resize(stage.num_poses());
  part.sweep(window_of(centre, stage), edge_rule_, 0, sums_);
  const ResponseTable table = responses(stage, use_penalty);
  MatchResult result = coarse;
  result.response = table.best_response();
  const SearchOffset best = mean_best_offset(table, result.response);
  result.T_map_sensor = moved(centre, best);
  result.covariance_map(2, 2) =
      variance_of_heading(part, centre, stage.heading_rad, best, result.response);
  return result;
}

SweepWindow CorrelativeMatcher::window_of(const Pose2& centre, const Stage& stage) const {
  const Eigen::Vector2i first = parts_.front().grid().cell_of(
      centre.translation_m() + Eigen::Vector2d::Constant(stage.position_m.offset(0)));
  return {first.x(), first.y(), stage.step_cells, stage.position_m.count()};
}

void CorrelativeMatcher::sweep_coarse(const Pose2& centre, const Stage& stage,
                                      std::uint32_t min_sum) {
  const SweepWindow window = window_of(centre, stage);
  sums_.resize(stage.num_poses());
  for_each_part([&](SearchPart& part, std::size_t index) {
    const HeadingRange headings = headings_of_part(index, 0, stage.heading_rad);
    const std::span<std::uint32_t> sums = std::span(sums_).subspan(
        static_cast<std::size_t>(headings.first) * window.num_positions(),
        static_cast<std::size_t>(headings.count()) * window.num_positions());
    part.sweep(window, edge_rule_, min_sum, sums);
  });
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

// The part is aimed at the headings of the fine search, which has just tried them.
double CorrelativeMatcher::variance_of_heading(SearchPart& part, const Pose2& centre,
                                               const SearchAxis& heading_rad,
                                               const SearchOffset& best, double best_response) {
  const Eigen::Vector2i cell = part.grid().cell_of(centre.translation_m() + best.position_m);
  sums_.resize(static_cast<std::size_t>(heading_rad.count()));
  part.sweep({cell.x(), cell.y(), 1, 1}, edge_rule_, 0, sums_);
  std::vector<double> responses;
  for (const std::uint32_t sum : sums_) responses.push_back(sum / full_response_);
  const double coarse_rad = params_.coarse_angle_resolution_rad;
  return heading_variance(responses, heading_rad, best_response, best.heading_rad,
                          4 * coarse_rad * coarse_rad);
}

}  // namespace corridor::karto
