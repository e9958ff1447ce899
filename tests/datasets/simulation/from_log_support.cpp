#include "tests/datasets/simulation/from_log_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "datasets/formats/log_io.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kTick_m = 1e-6;
// The seeds are always the same, so the outcome is too. That an honest simulator fails with just
// these has to be unlikely nevertheless: of some fifty figures within four standard errors each,
// any one does with a probability of 0.3 % at most (Bonferroni; uniform numbers do less often).
constexpr int kNumLogs = 800;

template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().to_line());
  return std::move(*result);
}

}  // namespace

RecordedRun recorded(const Scenario& scenario, std::uint64_t seed) {
  // On a disk, thousands of short logs would mostly wait for it: every log is flushed.
  const ::corridor::testing::ScratchFolder folder(::corridor::testing::memory_folder());
  const Simulated simulated = simulated_log(scenario, seed);
  const auto path = folder / "log.rawlog";
  if (const auto written = formats::write_log(simulated.log, path); !written) {
    throw std::runtime_error(written.error().to_line());
  }
  return {value_of(formats::read_log(path)),
          value_of(read_truth(folder.write("log.truth.toml", truth_toml(simulated))))};
}

Scenario honest_scenario() {
  Scenario scenario;
  scenario.name = "honest";
  scenario.world = world_of(
      {{{-5, -6}, {55, -6}}, {{55, -6}, {55, 6}}, {{55, 6}, {-5, 6}}, {{-5, 6}, {-5, -6}}});
  scenario.world.route_m = {{0, 0}, {50, 0}};
  scenario.lidar.num_beams = 4;
  scenario.lidar.range_max_m = 50;
  scenario.lidar.range_sigma_m = 0;
  scenario.wheels.m_per_tick = kTick_m;
  scenario.wheels.noise_ratio = scenario.wheels.scale_sigma = scenario.wheels.unbalance_sigma = 0;
  ImuParams& imu = scenario.imu;
  imu.rate_hz = 50;
  imu.gyro_noise_radps_rthz = imu.accel_noise_mps2_rthz = 0;
  imu.gyro_bias_sigma_radps = imu.accel_bias_sigma_mps2 = 0;
  DriveParams& drive = scenario.drive;
  drive.speed_min_mps = drive.speed_max_mps = 1;
  drive.start_spread_m = drive.heading_spread_deg = drive.lateral_spread_m = 0;
  return scenario;
}

Scenario honest_stay(double stand_s, double spin_turns) {
  Scenario scenario = honest_scenario();
  scenario.drive.stays = true;
  scenario.drive.stand_s = stand_s;
  scenario.drive.spin_turns = spin_turns;
  scenario.drive.yaw_rate_max_radps = 2;
  return scenario;
}

void expect_spreads(const Scenario& scenario, const std::vector<DrawnValue>& values) {
  std::vector<std::vector<double>> found(values.size());
  for (std::uint64_t seed = 1; seed <= kNumLogs; ++seed) {
    const RecordedRun run = recorded(scenario, seed);
    for (std::size_t i = 0; i < values.size(); ++i) found[i].push_back(values[i].found(run));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const DrawnValue& stated = values[i];
    EXPECT_NEAR(standard_deviation(found[i]) / stated.sigma, 1, four_sigma(kNumLogs))
        << stated.name;
    EXPECT_NEAR(mean(found[i]), stated.mean, 4 * stated.sigma / std::sqrt(1.0 * kNumLogs))
        << stated.name;
  }
}

double uniform_sigma(double half_range) { return half_range / std::sqrt(3.0); }

double four_sigma(double num_samples) { return 4 / std::sqrt(2 * num_samples); }

Counted counted(const RecordedRun& run) {
  Counted found;
  for (const WheelSample& sample : readings<WheelSample>(run.log)) {
    const auto left = static_cast<double>(sample.ticks->left);
    const auto right = static_cast<double>(sample.ticks->right);
    found.stamps_s.push_back(to_seconds(sample.stamp));
    found.common_m.push_back(0.5 * (left + right) * kTick_m);
    found.difference_m.push_back((right - left) * kTick_m);
  }
  return found;
}

double driven_m(const RecordedRun& run) {
  return run.log.truth->poses().back().T_map_base.x_m() -
         run.log.truth->poses().front().T_map_base.x_m();
}

double turned_rad(const RecordedRun& run) {
  const auto& poses = run.log.truth->poses();
  double sum_rad = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    sum_rad += wrap_angle(poses[i].T_map_base.theta_rad() - poses[i - 1].T_map_base.theta_rad());
  }
  return sum_rad;
}

double counted_between_scans_m(const RecordedRun& run, const std::vector<double>& column_m) {
  const std::vector<double> stamps_s = counted(run).stamps_s;
  const auto at = [&](Timestamp stamp) {
    for (std::size_t i = 0; i < stamps_s.size(); ++i) {
      if (std::abs(stamps_s[i] - to_seconds(stamp)) < 1e-6) return column_m[i];
    }
    throw std::runtime_error("no wheel sample at a scan's stamp");
  };
  return at(run.log.truth->poses().back().stamp) - at(run.log.truth->poses().front().stamp);
}

}  // namespace corridor::simulation::testing
