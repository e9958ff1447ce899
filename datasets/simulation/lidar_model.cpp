#include "datasets/simulation/lidar_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr int kRaysAcross = 5;          // of a beam with a width
constexpr double kSameSurface_m = 0.1;  // rays of a beam that differ less met one surface
constexpr double kMaxTangent = 10;
constexpr int kMaxPanes = 8;  // surfaces that one beam may pass through

Vector2d unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

}  // namespace

double beam_angle_rad(const LidarParams& params, int beam_index) {
  const double field_rad = params.field_of_view_deg * kRadPerDeg;
  const double increment_rad = field_rad / params.num_beams;
  return -field_rad / 2 + increment_rad / 2 + beam_index * increment_rad;
}

std::optional<BeamHit> LidarModel::meet(const Vector2d& origin_m, double direction_rad,
                                        std::span<const Person> people) const {
  const Vector2d direction = unit(direction_rad);
  std::optional<BeamHit> nearest_person;
  double limit_m = params_.range_max_m;
  for (const Person& person : people) {
    const std::optional<double> range_m = distance_to_m(person, origin_m, direction);
    if (!range_m || *range_m > limit_m) continue;
    limit_m = *range_m;
    const Vector2d normal = (origin_m + *range_m * direction - person.centre_m).normalized();
    nearest_person = BeamHit{*range_m, normal, std::abs(direction.dot(normal)), true};
  }
  double passed_m = 0;
  for (int pane = 0; pane < kMaxPanes; ++pane) {
    const auto hit = caster_.cast(origin_m, direction_rad, limit_m, passed_m);
    if (!hit) return nearest_person;
    const Vector2d normal = world_.normal(hit->surface_index, origin_m + hit->range_m * direction);
    const Material& material = world_.material(hit->surface_index);
    const double cosine = std::abs(direction.dot(normal));
    if (material.seen_within_deg < 90 && cosine < std::cos(material.seen_within_deg * kRadPerDeg)) {
      passed_m = hit->range_m;
      continue;
    }
    if (hit->range_m > material.range_factor * params_.range_max_m) return std::nullopt;
    return BeamHit{hit->range_m, normal, cosine, false};
  }
  return std::nullopt;
}

LidarModel::Ranges LidarModel::across_width(const Vector2d& origin_m, double direction_rad,
                                            std::span<const Person> people) const {
  const double width_rad = params_.beam_width_deg * kRadPerDeg;
  std::vector<double> ranges_m;
  for (int k = 0; k < kRaysAcross; ++k) {
    const double offset_rad = width_rad * ((k + 0.5) / kRaysAcross - 0.5);
    const auto hit = meet(origin_m, direction_rad + offset_rad, people);
    if (hit) ranges_m.push_back(hit->range_m);
  }
  if (ranges_m.empty()) return {};
  std::sort(ranges_m.begin(), ranges_m.end());
  const auto far =
      std::upper_bound(ranges_m.begin(), ranges_m.end(), ranges_m.front() + kSameSurface_m);
  const auto mean_m = [](auto begin, auto end) {
    return begin == end ? 0 : std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
  };
  Ranges ranges{mean_m(ranges_m.begin(), far), mean_m(far, ranges_m.end())};
  if (far - ranges_m.begin() < ranges_m.end() - far) std::swap(ranges.main_m, ranges.other_m);
  return ranges;
}

Sweep LidarModel::sweep(const PoseAt& T_world_base_at, std::span<const Person> people) const {
  Sweep sweep;
  const Pose2 mount = T_base_lidar(params_);
  const double beam_step_s =
      params_.num_beams > 1 ? params_.scan_duration_s / (params_.num_beams - 1) : 0;
  Pose2 T_world_lidar = T_world_base_at(0) * mount;
  for (int i = 0; i < params_.num_beams; ++i) {
    if (beam_step_s > 0) T_world_lidar = T_world_base_at(i * beam_step_s) * mount;
    const Vector2d origin_m = T_world_lidar.translation_m();
    const double direction_rad = T_world_lidar.theta_rad() + beam_angle_rad(params_, i);
    sweep.hits.push_back(meet(origin_m, direction_rad, people));
    Ranges ranges{sweep.hits.back() ? sweep.hits.back()->range_m : 0, 0};
    if (params_.beam_width_deg > 0) ranges = across_width(origin_m, direction_rad, people);
    sweep.ranges_m.push_back(ranges.main_m);
    sweep.other_ranges_m.push_back(ranges.other_m);
  }
  return sweep;
}

double LidarModel::sigma_m(double range_m, const std::optional<BeamHit>& hit) const {
  const double along_m = params_.range_sigma_ratio * range_m;
  double oblique_m = 0;
  if (params_.range_sigma_incidence_m > 0 && hit) {
    const double tangent = std::sqrt(1 - hit->cosine * hit->cosine) / hit->cosine;
    oblique_m = params_.range_sigma_incidence_m * std::min(tangent, kMaxTangent);
  }
  if (along_m == 0 && oblique_m == 0) return params_.range_sigma_m;
  return std::hypot(params_.range_sigma_m, along_m, oblique_m);
}

LaserScan LidarModel::measure(const Sweep& sweep, const Rng& rng) const {
  Rng noise = rng;
  Rng mixing = rng.stream("mixed");
  Rng dropouts = rng.stream("dropouts");
  LaserScan scan;
  scan.angle_min_rad = beam_angle_rad(params_, 0);
  scan.angle_increment_rad = params_.field_of_view_deg * kRadPerDeg / params_.num_beams;
  scan.range_min_m = params_.range_min_m;
  scan.range_max_m = params_.range_max_m;
  scan.duration_s = params_.scan_duration_s;
  scan.T_base_lidar = T_base_lidar(params_);
  for (std::size_t i = 0; i < sweep.hits.size(); ++i) {
    double range_m = sweep.ranges_m[i];
    const double other_m = sweep.other_ranges_m[i];
    if (range_m > 0 && other_m > 0 && mixing.uniform() < params_.mixed_pixel_ratio) {
      range_m += mixing.uniform() * (other_m - range_m);
    }
    const bool is_dropped = params_.dropout_ratio > 0 && dropouts.uniform() < params_.dropout_ratio;
    double measured_m = range_m + noise.normal(0, sigma_m(range_m, sweep.hits[i]));
    if (params_.range_step_m > 0) {
      measured_m = params_.range_step_m * std::round(measured_m / params_.range_step_m);
    }
    const auto reading_m = static_cast<float>(measured_m);
    const bool is_valid = range_m > 0 && !is_dropped && reading_m > 0 &&
                          reading_m >= params_.range_min_m && reading_m <= params_.range_max_m;
    scan.ranges_m.push_back(is_valid ? reading_m
                                     : static_cast<float>(params_.range_max_m + kNoReturnExcess_m));
    scan.is_valid.push_back(is_valid ? 1 : 0);
  }
  return scan;
}

}  // namespace corridor::simulation
