// The simulated LiDAR: what its beams meet, and the errors it adds. It knows no scenario file and
// no clock.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulation/people.hpp"
#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/sensor_params.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/scan.hpp"

namespace corridor::simulation {

// Farther than the sensor sees; the raw range of a beam without return.
inline constexpr double kNoReturnExcess_m = 1.0;

// Where a beam's middle truly ends.
struct BeamHit {
  double range_m = 0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // of the surface, in the world, unit length
  double cosine = 1;  // of the angle between the beam and the normal, in [0, 1]
  bool is_person = false;
};

// One sweep without any error, per beam.
struct Sweep {
  std::vector<std::optional<BeamHit>> hits;  // of the beam's middle; nullopt: nothing that returns
  std::vector<double> ranges_m;  // to the middle of what most of it meets; 0 = no return
  // Where a gap in depth parts what a beam with a width meets, to the second; else 0.
  std::vector<double> other_ranges_m;
};

class LidarModel {
 public:
  LidarModel(const World& world, const LidarParams& params)
      : world_(world), caster_(world), params_(params) {}

  // T_world_base a time in seconds after the first beam.
  using PoseAt = std::function<Pose2(double)>;

  [[nodiscard]] Sweep sweep(const PoseAt& T_world_base_at, std::span<const Person> people) const;
  // Adds the errors. One number of the main stream is drawn per beam, hit or not, so that a beam's
  // noise does not depend on the sensor's range; every further error has a stream of its own. A
  // noisy range outside [range_min, range_max] is no return.
  [[nodiscard]] LaserScan measure(const Sweep& sweep, const Rng& rng) const;

 private:
  struct RayEnd {
    BeamHit hit;
    std::size_t surface_index = 0;  // as World counts them; people are numbered after them
    bool is_returned = true;
  };
  // What a ray ends on within limit_m, whether it returns from there or not.
  [[nodiscard]] std::optional<RayEnd> meet(const Eigen::Vector2d& origin_m, double direction_rad,
                                           double limit_m, std::span<const Person> people) const;
  struct Beam {
    std::optional<BeamHit> hit;
    double range_m = 0, other_range_m = 0;
  };
  class WideBeam;
  [[nodiscard]] Beam beam(const Eigen::Vector2d& origin_m, double direction_rad,
                          std::span<const Person> people) const;
  [[nodiscard]] double sigma_m(double range_m, const std::optional<BeamHit>& hit) const;

  const World& world_;
  RayCaster caster_;
  LidarParams params_;
};

// Angle of a beam in the LiDAR's frame.
double beam_angle_rad(const LidarParams& params, int beam_index);

}  // namespace corridor::simulation
