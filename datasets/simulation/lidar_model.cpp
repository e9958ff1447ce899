#include "datasets/simulation/lidar_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kRaysAcross = 5;  // of a beam with a width, from edge to edge
constexpr double kDepthGap_m = 0.1;     // less in depth does not part what a beam meets
constexpr int kMaxHalvings = 10;        // between two rays, in search of a gap
constexpr double kMaxTangent = 10;
constexpr int kMaxPanes = 8;  // surfaces that one beam may pass through

Vector2d unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

}  // namespace

double beam_angle_rad(const LidarParams& params, int beam_index) {
  const double field_rad = params.field_of_view_deg * kRadPerDeg;
  const double increment_rad = field_rad / params.num_beams;
  return -field_rad / 2 + increment_rad / 2 + beam_index * increment_rad;
}

std::optional<LidarModel::RayEnd> LidarModel::meet(const Vector2d& origin_m, double direction_rad,
                                                   double limit_m,
                                                   std::span<const Person> people) const {
  const Vector2d direction = unit(direction_rad);
  std::optional<RayEnd> nearest_person;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::optional<double> range_m = distance_to_m(people[i], origin_m, direction);
    if (!range_m || *range_m > limit_m) continue;
    limit_m = *range_m;
    const Vector2d normal = (origin_m + *range_m * direction - people[i].centre_m).normalized();
    nearest_person = RayEnd{{*range_m, normal, std::abs(direction.dot(normal)), true},
                            world_.num_surfaces() + i,
                            *range_m <= params_.range_max_m};
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
    return RayEnd{{hit->range_m, normal, cosine, false},
                  hit->surface_index,
                  hit->range_m <= material.range_factor * params_.range_max_m};
  }
  return nearest_person;
}

// The rays across a beam with a width, from its one edge to the other. Neighbours met one thing if
// they name the same side of the same surface or differ little in depth, or if both halves between
// them do: a wall however oblique, the corner between two walls, the pieces of an arc. What is left
// is an edge with something behind it.
class LidarModel::WideBeam {
 public:
  WideBeam(const LidarModel& lidar, const Vector2d& origin_m, double direction_rad,
           std::span<const Person> people)
      : lidar_(lidar), origin_m_(origin_m), people_(people) {
    const double width_rad = lidar.params_.beam_width_deg * kRadPerDeg;
    for (std::size_t k = 0; k < kRaysAcross; ++k) {
      const double share = static_cast<double>(k) / (kRaysAcross - 1) - 0.5;
      rays_[k] = cast(direction_rad + share * width_rad);
    }
    for (std::size_t k = 0; k < kRaysAcross; ++k) part_of_[k] = find_part(k);
  }

  [[nodiscard]] Beam read() const {
    Beam beam;
    const std::optional<RayEnd>& middle = rays_[kRaysAcross / 2].end;
    if (middle && middle->is_returned) beam.hit = middle->hit;
    const std::optional<double> main_m = largest_part_m({});
    if (!main_m) return beam;
    beam.range_m = *main_m;
    beam.other_range_m = largest_part_m(main_m).value_or(0);
    return beam;
  }

 private:
  struct Ray {
    double direction_rad = 0;
    std::optional<RayEnd> end;
  };

  // To the end of the world, so that a surface is one beyond the sensor's range too.
  [[nodiscard]] Ray cast(double direction_rad) const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {direction_rad, lidar_.meet(origin_m_, direction_rad, kFar, people_)};
  }

  [[nodiscard]] bool is_same_side(const Ray& a, const Ray& b) const {
    const bool is_front = unit(a.direction_rad).dot(a.end->hit.normal) < 0;
    return a.end->surface_index == b.end->surface_index &&
           is_front == (unit(b.direction_rad).dot(b.end->hit.normal) < 0);
  }

  [[nodiscard]] bool is_one_surface(const Ray& a, const Ray& b, int num_halvings = 0) const {
    if (!a.end || !b.end) return !a.end && !b.end;
    if (is_same_side(a, b)) return true;
    if (std::abs(a.end->hit.range_m - b.end->hit.range_m) < kDepthGap_m) return true;
    if (num_halvings == kMaxHalvings) return false;
    const Ray middle = cast((a.direction_rad + b.direction_rad) / 2);
    return is_one_surface(a, middle, num_halvings + 1) &&
           is_one_surface(middle, b, num_halvings + 1);
  }

  // The first ray that met the same; what a thin thing in the middle hides goes on behind it.
  [[nodiscard]] std::size_t find_part(std::size_t k) const {
    if (k > 0 && is_one_surface(rays_[k - 1], rays_[k])) return part_of_[k - 1];
    for (std::size_t i = 0; i < k; ++i) {
      if (rays_[i].end && rays_[k].end && is_same_side(rays_[i], rays_[k])) return part_of_[i];
    }
    return k;
  }

  // Of the parts that return, the one that most rays met, or the nearer of two: the range to its
  // middle. Not that of range not_m.
  [[nodiscard]] std::optional<double> largest_part_m(std::optional<double> not_m) const {
    std::optional<double> best_m;
    std::size_t best_size = 0;
    for (std::size_t part = 0; part < kRaysAcross; ++part) {
      std::array<const RayEnd*, kRaysAcross> ends{};
      std::size_t size = 0;
      for (std::size_t k = 0; k < kRaysAcross; ++k) {
        if (rays_[k].end && part_of_[k] == part) ends[size++] = &*rays_[k].end;
      }
      if (size == 0) continue;
      const RayEnd& before = *ends[(size - 1) / 2];
      const RayEnd& after = *ends[size / 2];
      if (!before.is_returned || !after.is_returned) continue;
      const double range_m = (before.hit.range_m + after.hit.range_m) / 2;
      if (range_m == not_m || size < best_size) continue;
      if (size == best_size && best_m && range_m >= *best_m) continue;
      best_m = range_m;
      best_size = size;
    }
    return best_m;
  }

  const LidarModel& lidar_;
  Vector2d origin_m_;
  std::span<const Person> people_;
  std::array<Ray, kRaysAcross> rays_;
  std::array<std::size_t, kRaysAcross> part_of_{};
};

LidarModel::Beam LidarModel::beam(const Vector2d& origin_m, double direction_rad,
                                  std::span<const Person> people) const {
  if (params_.beam_width_deg > 0) return WideBeam(*this, origin_m, direction_rad, people).read();
  const auto end = meet(origin_m, direction_rad, params_.range_max_m, people);
  if (!end || !end->is_returned) return {};
  return {.hit = end->hit, .range_m = end->hit.range_m};
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
    const Beam met = beam(origin_m, direction_rad, people);
    sweep.hits.push_back(met.hit);
    sweep.ranges_m.push_back(met.range_m);
    sweep.other_ranges_m.push_back(met.other_range_m);
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
