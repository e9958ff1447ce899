// Held to the original program's own trajectories, pose by pose, where the recorded data are.
// original-results/NAME.karto.txt: open_karto with SPA at shipped parameters on the same logs.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "baselines/karto/karto_slam.hpp"
#include "datasets/formats/log_io.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/support/corridor_logs.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::karto {
namespace {

class OriginalKarto : public ::testing::TestWithParam<const char*> {};

TEST_P(OriginalKarto, IsReproducedPoseByPoseOnTheCorridorLog) {
  const std::string name = GetParam();
  const std::string log_name = "corridor/" + name + ".clf.gz";
  const auto log_file = testing::recorded_file(log_name);
  const auto original_file =
      testing::recorded_file("corridor/original-results/" + name + ".karto.txt");
  if (!log_file || !original_file) GTEST_SKIP() << testing::missing_data_message(log_name);
  const Result<SensorLog> log = formats::read_log(*log_file);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  const std::vector<testing::OriginalPose> original = testing::read_original_poses(*original_file);

  const auto slam =
      make_karto({}, log->robot, backend::make_least_squares(backend::spa_params()), 1);
  std::vector<bool> is_key_scan;
  for (const SensorEvent& event : log->events) {
    const Result<StepReport> report = slam->step(event);
    ASSERT_TRUE(report.has_value()) << report.error().to_line();
    if (report->T_map_base) is_key_scan.push_back(report->is_key_scan);
  }
  const Trajectory trajectory = slam->finish()->trajectory;

  ASSERT_EQ(trajectory.size(), original.size());
  const Pose2 T_odom_start = original.front().T_odom_base;
  for (std::size_t i = 0; i < original.size(); ++i) {
    EXPECT_EQ(is_key_scan[i], original[i].is_key_scan) << "scan " << i;
    const Pose2 error = (T_odom_start * trajectory[i].T_map_base).between(original[i].T_odom_base);
    // The file has 6 decimals; a decision that differs shows as a cell of 10 mm or 3.5 mrad.
    ASSERT_LT(error.translation_m().norm(), 1e-4) << "scan " << i;
    ASSERT_LT(std::abs(error.theta_rad()), 1e-4) << "scan " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(CorridorLogs, OriginalKarto, ::testing::ValuesIn(testing::kCorridorLogs),
                         testing::test_name);

}  // namespace
}  // namespace corridor::karto
