#include "tests/datasets/simulation/simulation_support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace corridor::simulation::testing {
namespace {

// Standard deviation of white noise from differences of neighbours, which cancel what varies
// slowly.
double noise_of(const std::vector<double>& samples) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    differences.push_back(samples[i] - samples[i - 1]);
  }
  return standard_deviation(differences) / std::numbers::sqrt2;
}

std::vector<double> speeds_mps(const Trajectory& trajectory) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector2d step_m =
        trajectory[i].T_map_base.translation_m() - trajectory[i - 1].T_map_base.translation_m();
    speeds.push_back(step_m.norm() / seconds_between(trajectory[i - 1].stamp, trajectory[i].stamp));
  }
  return speeds;
}

// Path of the odometry over path of the truth, scan by scan where the robot drives.
double wheel_path_ratio(const std::vector<Pose2>& odometry, const Trajectory& truth) {
  double odometry_m = 0;
  double truth_m = 0;
  const double least_m = 0.01;  // per scan; less is standing and turning
  for (std::size_t i = 1; i < std::min(odometry.size(), truth.size()); ++i) {
    const double step_m =
        truth[i - 1].T_map_base.between(truth[i].T_map_base).translation_m().norm();
    if (step_m < least_m) continue;
    truth_m += step_m;
    odometry_m += odometry[i - 1].between(odometry[i]).translation_m().norm();
  }
  return odometry_m / truth_m;
}

// Even-odd rule.
bool is_inside(const std::vector<Segment>& polygon, const Eigen::Vector2d& point_m) {
  bool inside = false;
  for (const Segment& wall : polygon) {
    if ((wall.a_m.y() > point_m.y()) == (wall.b_m.y() > point_m.y())) continue;
    const double ratio = (point_m.y() - wall.a_m.y()) / (wall.b_m.y() - wall.a_m.y());
    if (point_m.x() < wall.a_m.x() + ratio * (wall.b_m.x() - wall.a_m.x())) inside = !inside;
  }
  return inside;
}

}  // namespace

CorridorShape random_shape(Rng& rng) {
  for (;;) {
    CorridorShape shape{.a_m = rng.uniform(8, 30),
                        .b_m = rng.uniform(8, 30),
                        .c_m = rng.uniform(1.5, 6),
                        .alpha_rad = rng.uniform(35, 145) * std::numbers::pi / 180,
                        .doors_every_m = rng.uniform() < 0.5 ? 0 : rng.uniform(2, 5)};
    if (violations(shape).empty()) return shape;
  }
}

Eigen::Vector2d random_point_inside(const CorridorShape& shape, Rng& rng) {
  const KeyWalls key = key_walls(shape);
  const Segment& wall = rng.uniform() < 0.5 ? key.lower_outer : key.right_outer;
  const Eigen::Vector2d along = (wall.b_m - wall.a_m).normalized();
  const Eigen::Vector2d inward(-along.y(), along.x());
  const World plain = world_of({key.lower_outer, key.right_outer, key.top_end, key.right_inner,
                                key.lower_inner, key.left_end});
  for (;;) {
    // Next to a wall of either arm; where the arms meet at an angle this may lie beyond the other.
    const Eigen::Vector2d point_m = wall.a_m + rng.uniform(0.1, wall.length_m() - 0.1) * along +
                                    rng.uniform(0.1, shape.c_m - 0.1) * inward;
    if (is_inside(plain.walls, point_m) && clearance_m(plain, point_m) > 0.05) return point_m;
  }
}

DriveState cruising(double speed_mps, double yaw_rate_radps) {
  return {.T_world_base = {},
          .speed_mps = speed_mps,
          .wheel_speed_mps = speed_mps,
          .yaw_rate_radps = yaw_rate_radps};
}

double allan_deviation(const std::vector<double>& samples, std::size_t num_per_cluster) {
  std::vector<double> means;
  for (std::size_t i = 0; i + num_per_cluster <= samples.size(); i += num_per_cluster) {
    double sum = 0;
    for (std::size_t k = i; k < i + num_per_cluster; ++k) sum += samples[k];
    means.push_back(sum / static_cast<double>(num_per_cluster));
  }
  double sum = 0;
  for (std::size_t i = 1; i < means.size(); ++i) sum += std::pow(means[i] - means[i - 1], 2);
  return std::sqrt(0.5 * sum / static_cast<double>(means.size() - 1));
}

double allan_tolerance(std::size_t num_clusters) {
  return 5 / std::sqrt(static_cast<double>(num_clusters));
}

World world_of(std::vector<Segment> walls) {
  World world;
  world.walls = std::move(walls);
  return world;
}

double clearance_m(const World& world, const Eigen::Vector2d& point_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Segment& wall : world.walls) {
    const Eigen::Vector2d along = wall.b_m - wall.a_m;
    const double ratio =
        std::clamp((point_m - wall.a_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least_m = std::min(least_m, (wall.a_m + ratio * along - point_m).norm());
  }
  return least_m;
}

double five_sigma(std::size_t num_samples) {
  return 5 / std::sqrt(2.0 * static_cast<double>(num_samples));
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double standard_deviation(const std::vector<double>& values) {
  const double centre = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Scenario shipped_scenario(const std::string& name) {
  const auto path = find_scenario(name);
  if (!path) throw std::runtime_error(path.error().to_line());
  const auto scenario = read_scenario(*path);
  if (!scenario) throw std::runtime_error(scenario.error().to_line());
  return *scenario;
}

std::vector<LoggedBeam> logged_beams(const SensorLog& log) {
  std::vector<LoggedBeam> beams;
  std::size_t scan_index = 0;
  for (const SensorEvent& event : log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    const Pose2 T_world_base = (*log.truth)[scan_index++].T_map_base;
    const auto num_steps = static_cast<double>(scan->num_beams() - 1);
    for (std::size_t i = 0; i < scan->num_beams(); ++i) {
      beams.push_back({T_world_base, i, scan->angle_rad(i), static_cast<double>(i) / num_steps,
                       scan->is_valid[i] != 0, scan->ranges_m[i]});
    }
  }
  return beams;
}

Simulated simulated_log(const Scenario& scenario, std::uint64_t seed) {
  Result<Simulated> simulated = simulate(scenario, seed);
  if (!simulated) throw std::runtime_error(simulated.error().to_line());
  return std::move(*simulated);
}

LogFigures figures_of(const SensorLog& log) {
  std::vector<double> gyro, accel_x, left_m;
  std::vector<Pose2> odometry_at_scans;
  Pose2 T_odom_base;
  double left_path_m = 0;
  double num_beams = 0;
  double num_without_return = 0;
  for (const SensorEvent& event : log.events) {
    if (const auto* imu = std::get_if<ImuSample>(&event)) {
      gyro.push_back(imu->gyro_z_radps);
      accel_x.push_back(imu->accel_x_mps2);
    } else if (const auto* wheels = std::get_if<WheelSample>(&event)) {
      T_odom_base = wheels->T_odom_base;
      const double path_m =
          static_cast<double>(wheels->ticks->left) * log.robot.wheels.left_m_per_tick;
      left_m.push_back(path_m - left_path_m);
      left_path_m = path_m;
    } else {
      const auto& scan = std::get<LaserScan>(event);
      odometry_at_scans.push_back(T_odom_base);
      num_beams += static_cast<double>(scan.num_beams());
      num_without_return +=
          static_cast<double>(std::count(scan.is_valid.begin(), scan.is_valid.end(), 0));
    }
  }
  const Trajectory& truth = *log.truth;
  // A stretch of the first arm at cruising speed, 5 s after the start.
  const std::vector<double> cruising_m(left_m.begin() + 250, left_m.begin() + 650);
  const Eigen::Vector2d far_m = truth[truth.size() / 3].T_map_base.translation_m();
  const Eigen::Vector2d ahead_m = far_m - truth.front().T_map_base.translation_m();
  return {.duration_s = log.duration_s(),
          .path_length_m = truth.path_length_m(),
          .cruising_speed_mps = median(speeds_mps(truth)),
          .no_return_share = num_without_return / num_beams,
          .wheel_path_ratio = wheel_path_ratio(odometry_at_scans, truth),
          .gyro_noise_radps = noise_of(gyro),
          .accel_noise_mps2 = noise_of(accel_x),
          .tick_noise_m = noise_of(cruising_m),
          .initial_heading_error_rad = wrap_angle(truth.front().T_map_base.theta_rad() -
                                                  std::atan2(ahead_m.y(), ahead_m.x()))};
}

}  // namespace corridor::simulation::testing
