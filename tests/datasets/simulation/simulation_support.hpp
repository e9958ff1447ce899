// What the tests of the simulator share: random corridors, and figures measured on a log.
#pragma once

#include <vector>

#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::simulation::testing {

// Any corridor that can be drawn: alpha from 35 to 145 deg, doors in half of them.
CorridorShape random_shape(Rng& rng);

// A point inside the corridor, at least 5 cm from its walls.
Eigen::Vector2d random_point_inside(const CorridorShape& shape, Rng& rng);

// A robot that moves evenly and whose wheels grip.
DriveState cruising(double speed_mps, double yaw_rate_radps = 0);

// Square root of half the mean square difference of neighbouring means over so many samples.
double allan_deviation(const std::vector<double>& samples, std::size_t num_per_cluster);
// More than five standard errors of an Allan deviation from so many clusters, as a part of it: the
// standard error is 0.87 / sqrt(n) for white noise, up to 1 / sqrt(n) for slower noise.
double allan_tolerance(std::size_t num_clusters);

// A world of these walls, without materials and without a route.
World world_of(std::vector<Segment> walls);

// Distance from a point to the nearest wall [m].
double clearance_m(const World& world, const Eigen::Vector2d& point_m);

// Five standard errors of a standard deviation estimated from n normal samples, as a part of it.
double five_sigma(std::size_t num_samples);

double mean(const std::vector<double>& values);
double standard_deviation(const std::vector<double>& values);
double median(std::vector<double> values);

// A scenario file of datasets/scenarios/, which must be readable.
Scenario shipped_scenario(const std::string& name);

// What a log says of one beam, and where the robot was.
struct LoggedBeam {
  Pose2 T_world_base;  // at the scan's stamp
  std::size_t index = 0;
  double angle_rad = 0;    // in the LiDAR's frame
  double sweep_share = 0;  // of the time from the first beam to the last
  bool is_valid = false;
  double range_m = 0;
};
// Of all scans in order. Requires a true pose per scan.
std::vector<LoggedBeam> logged_beams(const SensorLog& log);
// What simulate() gives, which must be a log.
Simulated simulated_log(const Scenario& scenario, std::uint64_t seed);

// Figures of a log that need nothing but the log and its truth at the scans.
struct LogFigures {
  double duration_s = 0;
  double path_length_m = 0;
  double cruising_speed_mps = 0;  // median between scans
  double no_return_share = 0;     // of all beams
  double wheel_path_ratio = 0;    // odometry path / true path, while driving
  double gyro_noise_radps = 0;    // from differences of neighbouring samples
  double accel_noise_mps2 = 0;
  double tick_noise_m = 0;               // one wheel's increment per sample, while cruising
  double initial_heading_error_rad = 0;  // between the first pose and the first arm
};
LogFigures figures_of(const SensorLog& log);

}  // namespace corridor::simulation::testing
