#include "slam/core/robot_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor {
namespace {

TEST(RobotModel, DefaultsBreakNoRule) {
  EXPECT_EQ(violations(RobotModel{}), std::vector<std::string>{});
}

TEST(RobotModel, EveryBrokenRuleIsNamed) {
  RobotModel robot;
  robot.wheels = {
      .track_m = 0, .left_m_per_tick = -1, .right_m_per_tick = NAN, .sigma_m_per_sqrt_m = -1};
  robot.lidar = {.T_base_lidar = Pose2(NAN, 0, 0),
                 .range_min_m = -1,
                 .range_max_m = 0,
                 .range_sigma_m = INFINITY,
                 .scan_duration_s = NAN,
                 .time_offset_s = NAN};
  robot.imu = {.T_base_imu = Pose2(0, 0, NAN),
               .rate_hz = 0,
               .gyro_noise_radps = -1,
               .accel_noise_mps2 = -1,
               .gyro_bias_walk_radps_sqrt_s = -1,
               .accel_bias_walk_mps2_sqrt_s = -1};
  EXPECT_EQ(violations(robot).size(), 16u);
}

TEST(RobotModel, OffsetsOfTimeAreThoseOfSensorsNotOfCalendars) {
  RobotModel robot;
  robot.lidar.scan_duration_s = -0.1;
  robot.lidar.time_offset_s = -1e300;
  ASSERT_EQ(violations(robot).size(), 1u);
  EXPECT_EQ(violations(robot)[0],
            "lidar.time_offset_s = -1e+300: expected at most 1000 either way");
}

TEST(RobotModel, LidarMustSeeFartherThanItsNearLimit) {
  RobotModel robot;
  robot.lidar.range_min_m = 5;
  robot.lidar.range_max_m = 5;
  ASSERT_EQ(violations(robot).size(), 1u);
  EXPECT_EQ(violations(robot)[0], "lidar.range_min_m = 5: expected less than range_max_m = 5");
}

}  // namespace
}  // namespace corridor
