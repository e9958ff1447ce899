// Each error of the LiDAR, turned on alone, is found again in the log that it went into, by what a
// reader of the log and of the world can work out; nothing of the LiDAR's model is used here.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kNumErrors = 4;  // standard errors that an estimate may be off

// A room around the origin, 12 m x 9 m.
const Vector2d kLower_m(-5, -4), kUpper_m(7, 5);
World room() {
  const Vector2d right_m(kUpper_m.x(), kLower_m.y());
  const Vector2d left_m(kLower_m.x(), kUpper_m.y());
  World world =
      world_of({{kLower_m, right_m}, {right_m, kUpper_m}, {kUpper_m, left_m}, {left_m, kLower_m}});
  world.route_m = {{0, 0}, {4, 0}};
  return world;
}

// Where a ray from inside the room ends.
struct RayEnd {
  double range_m = 0;
  double tangent = 0;  // of the angle to the wall's normal
};
RayEnd ray_end(const Pose2& T_world_lidar, double angle_rad) {
  const double direction_rad = T_world_lidar.theta_rad() + angle_rad;
  const Vector2d direction(std::cos(direction_rad), std::sin(direction_rad));
  const Vector2d ranges_m =
      ((direction.array() > 0).select(kUpper_m, kLower_m) - T_world_lidar.translation_m())
          .cwiseQuotient(direction);
  const bool is_side = ranges_m.x() < ranges_m.y();
  const double tangent = std::abs(direction.y() / direction.x());
  return {ranges_m.minCoeff(), is_side ? tangent : 1 / tangent};
}

struct Estimate {
  double value = 0;
  double standard_error = 0;
};

// Noise that is `weight` times white noise of unknown standard deviation.
Estimate noise_of(const std::vector<LoggedBeam>& beams,
                  const std::function<double(const RayEnd&)>& weight) {
  double sum = 0;
  double num = 0;
  for (const LoggedBeam& beam : beams) {
    const RayEnd end = ray_end(beam.T_world_base, beam.angle_rad);
    if (!beam.is_valid || weight(end) < 0.1) continue;  // floats, and nothing to learn
    sum += std::pow((beam.range_m - end.range_m) / weight(end), 2);
    ++num;
  }
  const double sigma = std::sqrt(sum / num);
  return {sigma, sigma / std::sqrt(2 * num)};
}

// Errors of one scan: those of the next are the same where the robot stands. Uniform over a step,
// whose square has a relative standard deviation of sqrt(4 / 5).
Estimate step_of(std::vector<LoggedBeam> beams) {
  beams.resize(360);
  const double root_mean_square_m = noise_of(beams, [](const RayEnd&) { return 1; }).value;
  const double step_m = root_mean_square_m * std::sqrt(12.0);
  return {step_m, step_m * std::sqrt(0.2 / 360)};
}

Estimate share_of(double num_found, double num) {
  const double share = num_found / num;
  return {share, std::sqrt(share * (1 - share) / num)};
}

Estimate dropouts_of(const std::vector<LoggedBeam>& beams) {
  const auto num_lost = std::count_if(beams.begin(), beams.end(),
                                      [](const LoggedBeam& beam) { return !beam.is_valid; });
  return share_of(static_cast<double>(num_lost), static_cast<double>(beams.size()));
}

// Between the farthest reading and the nearest wall that gives none.
Estimate range_limit_of(const std::vector<LoggedBeam>& beams) {
  double farthest_m = 0;
  double nearest_unseen_m = std::numeric_limits<double>::infinity();
  for (const LoggedBeam& beam : beams) {
    if (beam.is_valid) {
      farthest_m = std::max(farthest_m, beam.range_m);
    } else {
      nearest_unseen_m =
          std::min(nearest_unseen_m, ray_end(beam.T_world_base, beam.angle_rad).range_m);
    }
  }
  const double half_gap_m = (nearest_unseen_m - farthest_m) / 2;
  return {farthest_m + half_gap_m, half_gap_m / kNumErrors};
}

Estimate lower_limit_of(const std::vector<LoggedBeam>& beams) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_unseen_m = 0;
  for (const LoggedBeam& beam : beams) {
    if (beam.is_valid) {
      nearest_m = std::min(nearest_m, beam.range_m);
    } else {
      farthest_unseen_m =
          std::max(farthest_unseen_m, ray_end(beam.T_world_base, beam.angle_rad).range_m);
    }
  }
  const double half_gap_m = (nearest_m - farthest_unseen_m) / 2;
  return {nearest_m - half_gap_m, half_gap_m / kNumErrors};
}

// Between the most oblique wall that gives a reading and the least that gives none.
Estimate seen_within_deg_of(const std::vector<LoggedBeam>& beams) {
  double seen_deg = 0;
  double unseen_deg = 90;
  for (const LoggedBeam& beam : beams) {
    const double incidence_deg =
        std::atan(ray_end(beam.T_world_base, beam.angle_rad).tangent) / kDegree_rad;
    double& limit_deg = beam.is_valid ? seen_deg : unseen_deg;
    limit_deg =
        beam.is_valid ? std::max(seen_deg, incidence_deg) : std::min(unseen_deg, incidence_deg);
  }
  const double half_gap_deg = (unseen_deg - seen_deg) / 2;
  return {seen_deg + half_gap_deg, half_gap_deg / kNumErrors};
}

// Every wall of the room is of this.
void build_of(const Material& material, Scenario& scenario) {
  scenario.world.materials = {material};
  scenario.world.material_of_surface.assign(scenario.world.walls.size(), 0);
}

// 36 edges: plates in a circle of 2 m around the origin, each over 10 degrees, in front of the
// room.
constexpr double kPlates_m = 2;
constexpr int kNumPlates = 18;
World picket_fence() {
  World world = room();
  world.route_m = {{0, 0}, {0.5, 0}};  // only its beginning is driven
  const auto point_m = [](double angle_deg) {
    return Vector2d(kPlates_m * std::cos(angle_deg * kDegree_rad),
                    kPlates_m * std::sin(angle_deg * kDegree_rad));
  };
  for (int k = 0; k < kNumPlates; ++k) {
    const double begin_deg = 20 * k + 0.6;  // a tenth of a degree past the middle of a beam
    world.walls.push_back({point_m(begin_deg), point_m(begin_deg + 10)});
  }
  return world;
}

// Of a robot that stands: what a beam reads when it is not mixed is what it reads most often.
Estimate mixed_share_of(const std::vector<LoggedBeam>& beams) {
  std::map<std::size_t, std::map<double, int>> num_times;
  for (const LoggedBeam& beam : beams) ++num_times[beam.index][beam.range_m];
  double num_mixed = 0;
  double num = 0;
  for (const auto& [index, times] : num_times) {
    if (times.size() == 1) continue;
    int most = 0;
    for (const auto& [range_m, count] : times) {
      num += count;
      num_mixed += count;
      most = std::max(most, count);
    }
    num_mixed -= most;
  }
  EXPECT_EQ(num, 2 * kNumPlates * static_cast<double>(beams.size() / 360));
  return share_of(num_mixed, num);
}

// Of a robot that turns, every beam on an edge being mixed: as a beam is to the step between beams,
// so are the mixed readings to the edges that passed.
Estimate beam_width_deg_of(const std::vector<LoggedBeam>& beams) {
  double num_mixed = 0;
  for (const LoggedBeam& beam : beams) {
    const bool is_on_a_plate = beam.range_m < kPlates_m + 0.001;
    const double to_wall_m = ray_end(beam.T_world_base, beam.angle_rad).range_m - beam.range_m;
    num_mixed += !is_on_a_plate && to_wall_m > 0.001;
  }
  const Estimate share =
      share_of(num_mixed, 2 * kNumPlates * static_cast<double>(beams.size() / 360));
  return {share.value, share.standard_error};  // beams 1 deg apart
}

// Of a robot that drives along +x at an even speed v: a beam that ends on a wall across the drive
// is shorter by v T times its share of the sweep. Least squares through the origin.
constexpr double kSweepNoise_m = 0.01;
Estimate sweep_time_of(const std::vector<LoggedBeam>& beams) {
  double sum_st = 0;
  double sum_ss = 0;
  for (std::size_t i = 0; i + 360 < beams.size(); ++i) {
    const LoggedBeam& beam = beams[i];
    const double speed_mps = (beams[i + 360].T_world_base.x_m() - beam.T_world_base.x_m()) / 0.1;
    const double depth_m = beam.range_m * std::cos(beam.angle_rad);
    const double width_m = beam.range_m * std::sin(beam.angle_rad);
    const bool is_on_a_side = width_m > kUpper_m.y() - 0.3 || width_m < kLower_m.y() + 0.3;
    if (std::abs(speed_mps - 0.5) > 1e-6 || is_on_a_side) continue;
    const double wall_m = depth_m > 0 ? kUpper_m.x() : kLower_m.x();
    const double driven_mps = speed_mps * beam.sweep_share;
    sum_st += driven_mps * (wall_m - beam.T_world_base.x_m() - depth_m);
    sum_ss += driven_mps * driven_mps;
  }
  return {sum_st / sum_ss, kSweepNoise_m / std::sqrt(sum_ss)};
}

// T_base_lidar that explains the ranges from a robot that stands, by Gauss-Newton; order (x_m, y_m,
// yaw_rad).
constexpr double kMountNoise_m = 0.01;
Estimate mounting_of(const std::vector<LoggedBeam>& beams, int component) {
  const auto range_m = [](const LoggedBeam& beam, const Vector3d& mount) {
    return ray_end(beam.T_world_base * Pose2(mount.x(), mount.y(), mount.z()), beam.angle_rad)
        .range_m;
  };
  constexpr double kStep = 1e-6;
  Vector3d mount = Vector3d::Zero();
  Eigen::Matrix3d information;
  for (int iteration = 0; iteration < 20; ++iteration) {
    information.setZero();
    Vector3d gradient = Vector3d::Zero();
    for (const LoggedBeam& beam : beams) {
      Vector3d slope;
      for (int k = 0; k < 3; ++k) {
        const Vector3d step = kStep * Vector3d::Unit(k);
        slope[k] = (range_m(beam, mount + step) - range_m(beam, mount - step)) / (2 * kStep);
      }
      information += slope * slope.transpose();
      gradient += slope * (beam.range_m - range_m(beam, mount));
    }
    mount += information.ldlt().solve(gradient);
  }
  return {mount[component], kMountNoise_m * std::sqrt(information.inverse()(component, component))};
}

struct Case {
  std::string name;
  double true_value;
  std::function<void(Scenario&)> turn_on;
  std::function<Estimate(const std::vector<LoggedBeam>&)> estimate;
};
void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

// A perfect LiDAR on a robot that stands in the room.
Scenario still() {
  Scenario scenario;
  scenario.world = room();
  scenario.lidar.range_sigma_m = 0;
  scenario.lidar.range_max_m = 30;
  scenario.drive.stand_s = 10;
  scenario.drive.stays = true;
  return scenario;
}

void put_at_origin(Scenario& scenario) {
  scenario.drive.start_spread_m = 0;
  scenario.drive.heading_spread_deg = 0;
}

void mount_aside(Scenario& scenario) {
  scenario.lidar.x_m = 0.2;
  scenario.lidar.y_m = -0.15;
  scenario.lidar.yaw_deg = 12;
  scenario.lidar.range_sigma_m = kMountNoise_m;
  scenario.drive.stand_s = 2;
}

std::vector<Case> cases() {
  return {
      {"range_sigma_m", 0.02, [](Scenario& s) { s.lidar.range_sigma_m = 0.02; },
       [](const auto& beams) { return noise_of(beams, [](const RayEnd&) { return 1; }); }},
      {"range_sigma_ratio", 0.004, [](Scenario& s) { s.lidar.range_sigma_ratio = 0.004; },
       [](const auto& beams) {
         return noise_of(beams, [](const RayEnd& end) { return end.range_m; });
       }},
      {"range_sigma_incidence_m", 0.006,
       [](Scenario& s) { s.lidar.range_sigma_incidence_m = 0.006; },
       [](const auto& beams) {
         return noise_of(beams, [](const RayEnd& end) { return std::min(end.tangent, 10.0); });
       }},
      {"range_step_m", 0.05, [](Scenario& s) { s.lidar.range_step_m = 0.05; }, step_of},
      {"dropout_ratio", 0.07, [](Scenario& s) { s.lidar.dropout_ratio = 0.07; }, dropouts_of},
      {"range_max_m", 5.5, [](Scenario& s) { s.lidar.range_max_m = 5.5; }, range_limit_of},
      {"range_min_m", 4.75, [](Scenario& s) { s.lidar.range_min_m = 4.75; }, lower_limit_of},
      // A LiDAR of 11 m sees dark walls to 5.5 m.
      {"range_factor", 0.5,
       [](Scenario& s) {
         s.lidar.range_max_m = 11;
         build_of({.name = "dark", .range_factor = 0.5}, s);
       },
       [](const auto& beams) {
         const Estimate limit_m = range_limit_of(beams);
         return Estimate{limit_m.value / 11, limit_m.standard_error / 11};
       }},
      {"seen_within_deg", 25,
       [](Scenario& s) { build_of({.name = "glass", .seen_within_deg = 25}, s); },
       seen_within_deg_of},
      {"mixed_pixel_ratio", 0.3,
       [](Scenario& s) {
         put_at_origin(s);
         s.world = picket_fence();
         s.lidar.beam_width_deg = 1;
         s.lidar.mixed_pixel_ratio = 0.3;
       },
       mixed_share_of},
      {"beam_width_deg", 0.4,
       [](Scenario& s) {
         put_at_origin(s);
         s.world = picket_fence();
         s.lidar.beam_width_deg = 0.4;
         s.lidar.mixed_pixel_ratio = 1;
         s.drive.stand_s = 0;
         s.drive.spin_turns = 1;
       },
       beam_width_deg_of},
      {"scan_duration_s", 0.08,
       [](Scenario& s) {
         put_at_origin(s);
         s.lidar.range_sigma_m = kSweepNoise_m;
         s.lidar.scan_duration_s = 0.08;
         s.drive = {.speed_min_mps = 0.5,
                    .speed_max_mps = 0.5,
                    .start_spread_m = 0,
                    .heading_spread_deg = 0,
                    .lateral_spread_m = 0};
       },
       sweep_time_of},
      {"x_m", 0.2, mount_aside, [](const auto& beams) { return mounting_of(beams, 0); }},
      {"y_m", -0.15, mount_aside, [](const auto& beams) { return mounting_of(beams, 1); }},
      {"yaw", 12 * kDegree_rad, mount_aside,
       [](const auto& beams) { return mounting_of(beams, 2); }},
  };
}

class LidarErrorFromALog : public ::testing::TestWithParam<Case> {};

TEST_P(LidarErrorFromALog, IsTheOneOfTheScenarioWithinItsStandardErrors) {
  const Case& of = GetParam();
  Scenario scenario = still();
  of.turn_on(scenario);
  ASSERT_EQ(violations(scenario), std::vector<std::string>{});
  const Estimate found = of.estimate(logged_beams(recorded(scenario, 1).log));
  EXPECT_NEAR(found.value, of.true_value, kNumErrors * found.standard_error);
  // So that neither nothing nor half of it would do.
  EXPECT_LT(kNumErrors * found.standard_error, 0.25 * std::abs(of.true_value));
}

INSTANTIATE_TEST_SUITE_P(Each, LidarErrorFromALog, ::testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace corridor::simulation::testing
