// Held to the original program's own trajectories, pose by pose, where the recorded data are.
// original-results/NAME.karto.txt: open_karto with SPA at shipped parameters on the same logs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "baselines/karto/karto_slam.hpp"
#include "datasets/formats/log_io.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::karto {
namespace {

struct OriginalPose {
  Pose2 T_odom_base;
  bool is_key_scan = false;
};

std::vector<OriginalPose> read_original(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<OriginalPose> poses;
  double stamp_s = 0;
  double x_m = 0;
  double y_m = 0;
  double theta_rad = 0;
  int is_key_scan = 0;
  while (in >> stamp_s >> x_m >> y_m >> theta_rad >> is_key_scan) {
    poses.push_back({Pose2(x_m, y_m, theta_rad), is_key_scan != 0});
  }
  return poses;
}

class OriginalKarto : public ::testing::TestWithParam<std::string> {};

TEST_P(OriginalKarto, IsReproducedPoseByPoseOnTheCorridorLog) {
  const std::string log_name = "corridor/" + GetParam() + ".clf.gz";
  const auto log_file = testing::recorded_file(log_name);
  const auto original_file =
      testing::recorded_file("corridor/original-results/" + GetParam() + ".karto.txt");
  if (!log_file || !original_file) GTEST_SKIP() << testing::missing_data_message(log_name);
  const Result<SensorLog> log = formats::read_log(*log_file);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  const std::vector<OriginalPose> original = read_original(*original_file);

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

INSTANTIATE_TEST_SUITE_P(CorridorLogs, OriginalKarto,
                         ::testing::Values("r12-s1", "r4.5-s1", "r4.5-s2", "r4.5-s3", "r4.5-s4",
                                           "r4.5-s5", "r4.5-s6", "r4.5-slip-s7", "r4.5-vary-s8"),
                         [](const auto& log) {
                           std::string name = log.param;
                           for (char& c : name) c = std::isalnum(c) != 0 ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace corridor::karto
