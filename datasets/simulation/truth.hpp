// What the simulator drew and no system may see: the sidecar LOG.truth.toml of a simulated log.
// The true poses are not here; they lie in LOG.tum.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/simulation/imu_model.hpp"
#include "datasets/simulation/wheel_model.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/result.hpp"

namespace corridor::simulation {

enum class SlipCause {
  kEvent,  // drawn; the robot's own motion is that of a drive without it
  kGrip,   // the floor gave less acceleration than the wheels were driven with
};

// While begin_s <= t < end_s both wheels spin: each turns (1 + ratio) times as far as the robot
// moves over it; for kGrip that is the mean. Where grip is limited too, an event's ratio is that on
// top of it.
struct SlipInterval {
  double begin_s = 0;
  double end_s = 0;
  double ratio = 0;
  SlipCause cause = SlipCause::kEvent;
};

// Scans from begin_s to end_s (stamps, both included) see walls of one direction only: they say
// nothing about the position along direction_rad (world frame, in [0, pi)); or, without a
// direction, they see no wall at all and say nothing about any.
struct DegenerateInterval {
  double begin_s = 0;
  double end_s = 0;
  std::optional<double> direction_rad;
};

// The IMU's bias at a moment of the wheels' clock.
struct ImuBiasSample {
  double stamp_s = 0;
  ImuBias bias;
};

struct SimulationTruth {
  World world;
  Pose2 T_world_base_start;
  WheelErrors wheels;
  std::vector<SlipInterval> slips;  // in order, none meets another
  ImuErrors imu;
  std::vector<ImuBiasSample> imu_bias;  // once a second; empty where it is that of `imu` throughout
  double lidar_time_offset_s = 0;       // its clock minus the wheels', known and unknown part
  double imu_time_offset_s = 0;
  double range_max_m = 0;
  double range_sigma_m = 0;
  // In order; nullopt where the sidecar does not say; some logs come from other simulators.
  std::optional<std::vector<DegenerateInterval>> degenerate;
};

// The text of LOG.truth.toml.
std::string truth_toml(const SimulationTruth& truth);

// Reads a LOG.truth.toml; unknown keys and missing ones are errors, but for [lidar]
// degenerate and blind: the degenerate intervals with a direction and those without.
Result<SimulationTruth> read_truth(const std::filesystem::path& path);

}  // namespace corridor::simulation
