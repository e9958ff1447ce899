// Golden counts and agreements of the recorded logs of raw numbers, read with the catalogue's
// calibration; each test skips itself where its file is not found.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/catalog/load_dataset.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::catalog {
namespace {

using corridor::testing::missing_data_message;
using corridor::testing::recorded_file;

Result<LoadedDataset> load(const char* name) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  if (!catalog) return tl::make_unexpected(catalog.error());
  return load_dataset(name, standard_data_dirs(), *catalog);
}

bool has_note(const SensorLog& log, const std::string& start) {
  for (const std::string& note : log.provenance.notes) {
    if (note.starts_with(start)) return true;
  }
  return false;
}

std::string all_notes(const SensorLog& log) {
  std::string text;
  for (const std::string& note : log.provenance.notes) text += note + "\n";
  return text;
}

// Integral of the gyro over the log, less the mean of the readings while the wheels rest.
struct Yaw {
  double gyro_rad = 0;
  double wheels_rad = 0;
};

// Unwrapped turn of wheels and gyro, counted in both directions, where the wheels turn the robot.
Yaw turns_of(const SensorLog& log) {
  Yaw yaw;
  const WheelSample* last_wheels = nullptr;
  double bias = 0;
  int num_still = 0;
  std::vector<std::pair<double, double>> steps;  // wheels, gyro * dt
  std::vector<double> durations_s;
  const ImuSample* imu = nullptr;
  for (const SensorEvent& event : log.events) {
    if (const auto* sample = std::get_if<ImuSample>(&event)) imu = sample;
    const auto* wheels = std::get_if<WheelSample>(&event);
    if (wheels == nullptr) continue;
    if (last_wheels != nullptr && imu != nullptr) {
      const double dt_s = seconds_between(last_wheels->stamp, wheels->stamp);
      const Pose2 step = last_wheels->T_odom_base.between(wheels->T_odom_base);
      steps.emplace_back(step.theta_rad(), imu->gyro_z_radps * dt_s);
      durations_s.push_back(dt_s);
      if (step == Pose2()) {
        bias += imu->gyro_z_radps;
        ++num_still;
      }
    }
    last_wheels = wheels;
  }
  bias /= std::max(num_still, 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    yaw.wheels_rad += steps[i].first;
    yaw.gyro_rad += steps[i].second - bias * durations_s[i];
  }
  return yaw;
}

TEST(MbotEmptyLog, HasItsPublishedCountsAndSaysWhatWasChanged) {
  const char* file = "mbot/empty_environment.lcm.log.gz";
  if (!recorded_file(file)) GTEST_SKIP() << missing_data_message(file);
  const auto loaded = load("mbot-empty");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  const SensorLog& log = loaded->log;
  EXPECT_EQ(log.num_scans(), 403U);
  EXPECT_EQ(log.num_wheel_samples(), 1506U);
  EXPECT_EQ(log.num_imu_samples(), 1506U);
  EXPECT_NEAR(log.duration_s(), 58.8, 0.2);
  // 402 in the log; the first has a garbage stamp.
  EXPECT_EQ(log.truth->size(), 401U);
  EXPECT_TRUE(has_note(log, "1 reference poses with a stamp outside")) << all_notes(log);
  EXPECT_TRUE(has_note(log, "401 poses of the log itself stand in for truth")) << all_notes(log);
  EXPECT_NEAR(log.robot.lidar.scan_duration_s, -0.146, 0.002);  // a clockwise turn
}

// [Umeyama1991] in the plane: the least root mean square distance of matched points [m].
double aligned_rmse_m(const std::vector<Eigen::Vector2d>& a,
                      const std::vector<Eigen::Vector2d>& b) {
  const auto n = static_cast<double>(a.size());
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double sine = 0;
  double cosine = 0;
  double sum_m2 = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d p = a[i] - mean_a;
    const Eigen::Vector2d q = b[i] - mean_b;
    sine += p.x() * q.y() - p.y() * q.x();
    cosine += p.dot(q);
    sum_m2 += p.squaredNorm() + q.squaredNorm();
  }
  return std::sqrt((sum_m2 - 2 * std::hypot(sine, cosine)) / n);
}

TEST(MbotEmptyLog, DeadReckoningAgreesWithTheReferenceToItsPublishedCentimetres) {
  const char* file = "mbot/empty_environment.lcm.log.gz";
  if (!recorded_file(file)) GTEST_SKIP() << missing_data_message(file);
  const auto loaded = load("mbot-empty");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  Trajectory wheels;
  for (const SensorEvent& event : loaded->log.events) {
    const auto* sample = std::get_if<WheelSample>(&event);
    if (sample != nullptr) {
      ASSERT_TRUE(wheels.append({sample->stamp, sample->T_odom_base, {}}));
    }
  }
  std::vector<Eigen::Vector2d> found_m;
  std::vector<Eigen::Vector2d> reference_m;
  for (const TrajectoryPose& pose : loaded->log.truth->poses()) {
    const auto T_odom_base = wheels.interpolate(pose.stamp);
    if (!T_odom_base) continue;
    found_m.push_back(T_odom_base->translation_m());
    reference_m.push_back(pose.T_map_base.translation_m());
  }
  EXPECT_EQ(found_m.size(), 401U);
  constexpr double kPublished_m = 0.027;
  constexpr double kRounded_m = 0.0005;
  EXPECT_NEAR(aligned_rmse_m(found_m, reference_m), kPublished_m, kRounded_m);
}

TEST(MbotEmptyLog, GyroAndWheelsTurnTheSameWayByTheSameAmount) {
  const char* file = "mbot/empty_environment.lcm.log.gz";
  if (!recorded_file(file)) GTEST_SKIP() << missing_data_message(file);
  const auto loaded = load("mbot-empty");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  const Yaw yaw = turns_of(loaded->log);
  EXPECT_LT(yaw.wheels_rad, -11);
  EXPECT_NEAR(yaw.gyro_rad / yaw.wheels_rad, 1.019, 0.01);
}

TEST(MbotA0Log, HasItsPublishedCountsUpToTheCutAndOneClock) {
  const char* file = "mbot/chickensouple_a0.lcm.log.gz";
  if (!recorded_file(file)) GTEST_SKIP() << missing_data_message(file);
  const auto loaded = load("mbot-a0");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  const SensorLog& log = loaded->log;
  // 642 scans and 1637 readings of wheels and IMU in 81.9 s, of which 62 s are used.
  EXPECT_EQ(log.num_wheel_samples(), log.num_imu_samples());
  EXPECT_NEAR(static_cast<double>(log.num_scans()), 642 * 62 / 81.9, 4);
  EXPECT_NEAR(static_cast<double>(log.num_wheel_samples()), 1637 * 62 / 81.9, 4);
  EXPECT_FALSE(log.truth.has_value());
  EXPECT_NEAR(log.robot.lidar.scan_duration_s, -0.127, 0.002);
  EXPECT_TRUE(has_note(log,
                       "stamps of the wheels moved onto the LiDAR's clock by the events' "
                       "times: 1416989855.14"))
      << all_notes(log);
  EXPECT_TRUE(has_note(log, "407 beams of negative range")) << all_notes(log);
}

TEST(MinesLog, HasItsPublishedCounts) {
  const char* file = "ticks/mines-exp2.dat.gz";
  if (!recorded_file(file)) GTEST_SKIP() << missing_data_message(file);
  const auto loaded = load("mines");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  const SensorLog& log = loaded->log;
  EXPECT_EQ(log.num_scans(), 641U);
  EXPECT_EQ(log.num_wheel_samples(), 641U);
  EXPECT_NEAR(log.duration_s(), 63.2, 0.2);
  double path_m = 0;
  std::optional<Pose2> last;
  for (const SensorEvent& event : log.events) {
    const auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr) continue;
    if (last) path_m += last->between(sample->T_odom_base).translation_m().norm();
    last = sample->T_odom_base;
  }
  EXPECT_NEAR(path_m, 44.5, 0.5);  // twice that of 2000 ticks per half turn
}

}  // namespace
}  // namespace corridor::catalog
