#include "datasets/formats/robot_toml.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace corridor::formats {
namespace {

constexpr const char* kWheels =
    "[wheels]\ntrack_m = 0.35\nleft_m_per_tick = 1.0e-4\nright_m_per_tick = 1.0e-4\n";

RC_GTEST_PROP(RobotToml, ReadUndoesWrite, (int a, int b, int c)) {
  const auto positive = [](int value) { return 1e-6 + std::abs(value % 100'000) / 997.0; };
  RobotModel robot;
  robot.name = "a \"quoted\" name\nof two lines";
  robot.wheels = {positive(a), positive(b), positive(c), positive(a)};
  robot.lidar = {Pose2(a % 100 / 7.0, b % 100 / 7.0, c / 1e4),
                 0.01,
                 positive(b) + 1,
                 positive(a),
                 positive(b),
                 -positive(c)};
  robot.imu.T_base_imu = Pose2(0.1, -0.2, a / 1e4);
  robot.imu.rate_hz = positive(c);
  const auto read = robot_from_toml(robot_to_toml(robot), "text");
  RC_ASSERT(read.has_value());
  RC_ASSERT(robot_to_toml(*read) == robot_to_toml(robot));
  RC_ASSERT(read->wheels.track_m == robot.wheels.track_m);
  RC_ASSERT(read->lidar.time_offset_s == robot.lidar.time_offset_s);
  RC_ASSERT(std::abs(wrap_angle(read->lidar.T_base_lidar.theta_rad() -
                                robot.lidar.T_base_lidar.theta_rad())) < 1e-15);
}

TEST(RobotToml, OnlyTheWheelsAreRequired) {
  const auto robot = robot_from_toml(kWheels, "text");
  ASSERT_TRUE(robot.has_value()) << robot.error().to_line();
  EXPECT_EQ(robot->wheels.track_m, 0.35);
  EXPECT_EQ(robot->lidar.range_max_m, RobotModel{}.lidar.range_max_m);
}

TEST(RobotToml, AnglesAreDegrees) {
  const auto robot = robot_from_toml(std::string(kWheels) + "[lidar]\nyaw_deg = 90\n", "text");
  EXPECT_DOUBLE_EQ(robot->lidar.T_base_lidar.theta_rad(), std::acos(-1) / 2);
}

TEST(RobotToml, ListsEveryViolationAtOnce) {
  const auto robot = robot_from_toml(
      "[wheels]\ntrack_m = -1.0\nleft_m_per_tick = \"x\"\n[lidar]\nfoo = 1\n[bar]\n", "file");
  ASSERT_FALSE(robot.has_value());
  const std::string line = robot.error().to_line();
  for (const char* part :
       {"file: ", "wheels.track_m = -1", "left_m_per_tick: not a finite number",
        "right_m_per_tick: missing", "lidar.foo: unknown key", "bar: unknown key"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
}

TEST(RobotToml, NamesTheLineOfASyntaxError) {
  const auto robot = robot_from_toml("[wheels]\ntrack_m = = 1\n", "file");
  ASSERT_FALSE(robot.has_value());
  EXPECT_NE(robot.error().to_line().find("file:2: "), std::string::npos);
}

TEST(RobotToml, AnOverrideWithoutAKeyIsRefused) {
  for (const char* text : {"", "# nothing yet\n", "[lidar]\n[imu]\n"}) {
    const auto stated = override_robot(RobotModel{}, text, "a.robot.toml");
    ASSERT_FALSE(stated.has_value()) << text;
    EXPECT_EQ(stated.error().to_line(), "a.robot.toml: states nothing; expected at least one key");
  }
}

TEST(RobotToml, AnOverrideKeepsWhatItDoesNotName) {
  RobotModel base;
  base.wheels.track_m = 0.5;
  base.lidar.T_base_lidar = Pose2(1, 2, 3);
  const auto stated = override_robot(base, "[lidar]\nx_m = 4\nrange_max_m = 12\n", "file");
  ASSERT_TRUE(stated.has_value());
  EXPECT_EQ(stated->robot.wheels.track_m, 0.5);
  EXPECT_EQ(stated->robot.lidar.T_base_lidar, Pose2(4, 2, 3));
  EXPECT_TRUE(stated->states_lidar_pose);
  EXPECT_TRUE(stated->states_range_max);
  EXPECT_FALSE(stated->states_imu_pose);
}

}  // namespace
}  // namespace corridor::formats
