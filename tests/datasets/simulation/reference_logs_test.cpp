// The simulator against logs of the same robot in the same corridor that another simulator made:
// the two share no code, so that what both agree on is the robot and not a mistake.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "datasets/formats/log_io.hpp"
#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::missing_data_message;
using ::corridor::testing::recorded_file;

constexpr int kNumOurs = 20;

std::vector<LogFigures> our_figures(const std::string& scenario) {
  std::vector<LogFigures> figures;
  for (std::uint64_t seed = 1; seed <= kNumOurs; ++seed) {
    figures.push_back(figures_of(simulated_log(shipped_scenario(scenario), seed).log));
  }
  return figures;
}

template <class Field>
std::vector<double> column(const std::vector<LogFigures>& figures, Field field) {
  std::vector<double> values;
  for (const LogFigures& row : figures) values.push_back(row.*field);
  return values;
}

class ReferenceLogs : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 1; i <= 6; ++i) {
      const std::string name = "corridor/r4.5-s" + std::to_string(i) + ".rawlog";
      const auto file = recorded_file(name);
      if (!file) GTEST_SKIP() << missing_data_message(name);
      const auto log = formats::read_log(*file);
      ASSERT_TRUE(log) << log.error().to_line();
      theirs_.push_back(figures_of(*log));
    }
    ours_ = our_figures("paper-corridor");
  }

  std::vector<LogFigures> theirs_;
  std::vector<LogFigures> ours_;
};

// One test reads the logs for all: the figures are compared one by one with a reason each.
TEST_F(ReferenceLogs, AgreeInEveryFigureOfTheRobot) {
  const auto mean_of = [](const std::vector<LogFigures>& figures, auto field) {
    return mean(column(figures, field));
  };
  // Depends on the path's place in the corridor: 0.375 to 0.381 in both.
  EXPECT_NEAR(mean_of(ours_, &LogFigures::no_return_share),
              mean_of(theirs_, &LogFigures::no_return_share), 0.004);
  // Same route: means of 25.5 m, standard deviation 0.3 m over six.
  EXPECT_NEAR(mean_of(ours_, &LogFigures::path_length_m),
              mean_of(theirs_, &LogFigures::path_length_m), 0.5);
  // White noise of 10000 samples per log: 1 % is five standard errors.
  EXPECT_NEAR(mean_of(ours_, &LogFigures::gyro_noise_radps),
              mean_of(theirs_, &LogFigures::gyro_noise_radps), 0.01 * 0.01);
  EXPECT_NEAR(mean_of(ours_, &LogFigures::accel_noise_mps2),
              mean_of(theirs_, &LogFigures::accel_noise_mps2), 0.01 * 0.05);
  // Grows with the speed drawn: 0.1 mm at 0.4 to 0.12 mm at 0.6 m/s, ticks of 0.1 mm included.
  EXPECT_NEAR(mean_of(ours_, &LogFigures::tick_noise_m),
              mean_of(theirs_, &LogFigures::tick_noise_m), 1.5e-5);
  // Uniform in 0.4 to 0.6 m/s: standard error of six 0.024 m/s.
  EXPECT_NEAR(mean_of(ours_, &LogFigures::cruising_speed_mps),
              mean_of(theirs_, &LogFigures::cruising_speed_mps), 0.06);
}

TEST_F(ReferenceLogs, LieInsideTheSpreadOfOurSeeds) {
  const auto expect_inside = [&](auto field, double slack, const char* name) {
    const auto ours = column(ours_, field);
    const double low = *std::min_element(ours.begin(), ours.end()) - slack;
    const double high = *std::max_element(ours.begin(), ours.end()) + slack;
    for (const double value : column(theirs_, field)) {
      EXPECT_GE(value, low) << name;
      EXPECT_LE(value, high) << name;
    }
  };
  expect_inside(&LogFigures::duration_s, 2, "duration");
  expect_inside(&LogFigures::path_length_m, 0.5, "path length");
  expect_inside(&LogFigures::cruising_speed_mps, 0.02, "speed");
  expect_inside(&LogFigures::no_return_share, 0.003, "share of beams without return");
  expect_inside(&LogFigures::wheel_path_ratio, 0.02, "wheel scale");
  expect_inside(&LogFigures::initial_heading_error_rad, 0.15, "start heading");
}

TEST(ReferenceSlipLog, ItsWheelsTurnByTheRatioMoreThanTheRobotMoves) {
  const auto file = recorded_file("corridor/r4.5-slip-s7.rawlog");
  const auto truth_file = recorded_file("corridor/r4.5-slip-s7.truth.toml");
  if (!file || !truth_file) GTEST_SKIP() << missing_data_message("corridor/r4.5-slip-s7.rawlog");
  const auto log = formats::read_log(*file);
  const auto truth = read_truth(*truth_file);
  ASSERT_TRUE(log) << log.error().to_line();
  ASSERT_TRUE(truth) << truth.error().to_line();
  // Inside the first slip, before the second begins.
  const SlipInterval& slip = truth->slips.front();
  const Timestamp begin = timestamp_from_seconds(slip.begin_s + 0.1);
  const Timestamp end = timestamp_from_seconds(truth->slips[1].begin_s - 0.1);
  Trajectory odometry;
  for (const SensorEvent& event : log->events) {
    if (const auto* wheels = std::get_if<WheelSample>(&event)) {
      ASSERT_TRUE(odometry.append({wheels->stamp, wheels->T_odom_base, std::nullopt}));
    }
  }
  const double odometry_m =
      odometry.interpolate(begin)->between(*odometry.interpolate(end)).translation_m().norm();
  const double true_m =
      log->truth->interpolate(begin)->between(*log->truth->interpolate(end)).translation_m().norm();
  const double scale = 0.5 * (truth->wheels.left_scale + truth->wheels.right_scale);
  // 0.4 m with 0.7 mm of noise.
  EXPECT_NEAR(odometry_m / true_m / scale, 1 + slip.ratio, 0.01);
}

}  // namespace
}  // namespace corridor::simulation::testing
