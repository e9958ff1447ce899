// What happens to messages on their way into the log, found in recorded logs.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

// The moment around which a turn lies: the mean of the stamps, weighted by the parts of the turn.
double middle_of_turn_s(const std::vector<double>& stamps_s, const std::vector<double>& parts) {
  double sum = 0, weighted = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    sum += parts[i];
    weighted += parts[i] * stamps_s[i];
  }
  return weighted / sum;
}

double of_wheels_s(const RecordedRun& run) {
  const Counted wheels = counted(run);
  std::vector<double> stamps_s, parts;
  for (std::size_t i = 1; i < wheels.stamps_s.size(); ++i) {
    stamps_s.push_back(0.5 * (wheels.stamps_s[i] + wheels.stamps_s[i - 1]));
    parts.push_back(wheels.difference_m[i] - wheels.difference_m[i - 1]);
  }
  return middle_of_turn_s(stamps_s, parts);
}

double imu_offset_s(const RecordedRun& run) {
  std::vector<double> stamps_s, parts;
  for (const ImuSample& sample : readings<ImuSample>(run.log)) {
    stamps_s.push_back(to_seconds(sample.stamp));
    parts.push_back(sample.gyro_z_radps);
  }
  return middle_of_turn_s(stamps_s, parts) - of_wheels_s(run);
}

// A scan's true pose keeps the scan's stamp, which is that of the LiDAR's clock.
double lidar_offset_s(const RecordedRun& run) {
  std::vector<double> stamps_s, parts;
  const auto& poses = run.log.truth->poses();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    stamps_s.push_back(0.5 * (to_seconds(poses[i].stamp) + to_seconds(poses[i - 1].stamp)));
    parts.push_back(
        wrap_angle(poses[i].T_map_base.theta_rad() - poses[i - 1].T_map_base.theta_rad()));
  }
  return middle_of_turn_s(stamps_s, parts) - of_wheels_s(run);
}

TEST(ClockSpread, OfOffsetsOverLogsIsTheStatedOne) {
  Scenario scenario = honest_stay(0.5, 0.5);
  scenario.lidar.rate_hz = 50;
  scenario.lidar.time_offset_s = 0.1;
  scenario.lidar.time_offset_sigma_s = 0.02;
  scenario.imu.time_offset_sigma_s = 0.03;
  expect_spreads(scenario, {{"lidar", lidar_offset_s, 0.1, 0.02}, {"imu", imu_offset_s, 0, 0.03}});
}

struct MessageCase {
  std::string name;
  MessageParams& (*params)(Scenario&);
  double& (*rate_hz)(Scenario&);
  std::vector<double> (*stamps_s)(const SensorLog&);
};

template <class T>
std::vector<double> stamps_of(const SensorLog& log) {
  std::vector<double> stamps_s;
  for (const T& reading : readings<T>(log)) stamps_s.push_back(to_seconds(reading.stamp));
  return stamps_s;
}

class Messages : public ::testing::TestWithParam<MessageCase> {
 protected:
  static constexpr double kRate_hz = 50;
  static constexpr double kDuration_s = 40;

  static std::vector<double> stamps_with(const MessageParams& params) {
    Scenario scenario = honest_stay(kDuration_s);
    GetParam().rate_hz(scenario) = kRate_hz;
    GetParam().params(scenario) = params;
    return GetParam().stamps_s(recorded(scenario, 1).log);
  }
};

TEST_P(Messages, JitterByTheStatedSigma) {
  std::vector<double> errors_s;
  for (const double stamp_s : stamps_with({.time_jitter_s = 0.002})) {
    errors_s.push_back(stamp_s - std::round(stamp_s * kRate_hz) / kRate_hz);
  }
  EXPECT_NEAR(standard_deviation(errors_s) / 0.002, 1,
              four_sigma(static_cast<double>(errors_s.size())));
}

TEST_P(Messages, GetLostInTheStatedShare) {
  const double num_sent = kRate_hz * kDuration_s;
  const auto num_arrived = static_cast<double>(stamps_with({.loss_ratio = 0.1}).size());
  EXPECT_NEAR(1 - num_arrived / num_sent, 0.1, 4 * std::sqrt(0.1 * 0.9 / num_sent));
}

INSTANTIATE_TEST_SUITE_P(
    FromLogs, Messages,
    ::testing::Values(
        MessageCase{"Lidar", [](Scenario& s) -> MessageParams& { return s.lidar.message; },
                    [](Scenario& s) -> double& { return s.lidar.rate_hz; }, stamps_of<LaserScan>},
        MessageCase{"Wheels", [](Scenario& s) -> MessageParams& { return s.wheels.message; },
                    [](Scenario& s) -> double& { return s.wheels.rate_hz; },
                    stamps_of<WheelSample>},
        MessageCase{"Imu", [](Scenario& s) -> MessageParams& { return s.imu.message; },
                    [](Scenario& s) -> double& { return s.imu.rate_hz; }, stamps_of<ImuSample>}),
    [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace corridor::simulation::testing
