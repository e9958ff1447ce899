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
  RC_ASSERT(robot_to_toml(read->robot) == robot_to_toml(robot));
  RC_ASSERT(read->robot.wheels.track_m == robot.wheels.track_m);
  RC_ASSERT(read->robot.lidar.time_offset_s == robot.lidar.time_offset_s);
  RC_ASSERT(std::abs(wrap_angle(read->robot.lidar.T_base_lidar.theta_rad() -
                                robot.lidar.T_base_lidar.theta_rad())) < 1e-15);
}

TEST(RobotToml, OnlyTheWheelsAreRequired) {
  const auto robot = robot_from_toml(kWheels, "text");
  ASSERT_TRUE(robot.has_value()) << robot.error().to_line();
  EXPECT_EQ(robot->robot.wheels.track_m, 0.35);
  EXPECT_EQ(robot->robot.lidar.range_max_m, RobotModel{}.lidar.range_max_m);
}

TEST(RobotToml, AnglesAreDegrees) {
  const auto robot = robot_from_toml(std::string(kWheels) + "[lidar]\nyaw_deg = 90\n", "text");
  EXPECT_DOUBLE_EQ(robot->robot.lidar.T_base_lidar.theta_rad(), std::acos(-1) / 2);
}

TEST(RobotToml, ListsEveryViolationAtOnceEachWithItsLine) {
  const auto robot = robot_from_toml(
      "[wheels]\n"                 // 1
      "track_m = -1.0\n"           // 2
      "left_m_per_tick = \"x\"\n"  // 3
      "[lidar]\n"                  // 4
      "foo = 1\n"                  // 5
      "[bar]\n",                   // 6
      "file");
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().to_line(),
            "file:1: wheels.right_m_per_tick is missing; expected number; "
            "file:3: wheels.left_m_per_tick is a text; expected number; "
            "file:5: unknown key lidar.foo; expected one of x_m y_m yaw_deg range_min_m "
            "range_max_m range_sigma_m scan_duration_s time_offset_s; "
            "file:6: unknown key bar; expected one of robot wheels lidar imu; "
            "file:2: wheels.track_m = -1: expected a finite number > 0");
}

// What an override that is wrong is answered with.
std::string refusal_of(const std::string& text) {
  const auto stated = override_robot(RobotModel{}, text, "a.robot.toml");
  return stated ? "is read" : stated.error().to_line();
}

TEST(RobotToml, AMisspeltKeyIsToldTheKeysOfItsTable) {
  EXPECT_EQ(refusal_of("# mine\n[wheels]\ntrak_m = 0.35\n"),
            "a.robot.toml:3: unknown key wheels.trak_m; expected one of track_m left_m_per_tick "
            "right_m_per_tick sigma_m_per_sqrt_m");
}

TEST(RobotToml, AKeyInAnotherTableIsToldTheKeysOfThatTable) {
  EXPECT_EQ(refusal_of("[robot]\nname = \"a\"\ntrack_m = 0.35\n"),
            "a.robot.toml:3: unknown key robot.track_m; expected one of name");
}

TEST(RobotToml, AMisspeltTableIsToldTheTables) {
  EXPECT_EQ(refusal_of("[wheels]\ntrack_m = 0.35\n[laser]\nx_m = 1\n"),
            "a.robot.toml:3: unknown key laser; expected one of robot wheels lidar imu raw");
  EXPECT_EQ(refusal_of("wheels = 3\n"), "a.robot.toml:1: wheels is not a table; expected one");
}

TEST(RobotToml, AValueOfAnotherTypeIsSaidToBeThat) {
  EXPECT_EQ(refusal_of("[wheels]\ntrack_m = \"0.35\"\n"),
            "a.robot.toml:2: wheels.track_m is a text; expected number");
  EXPECT_EQ(refusal_of("[lidar]\nyaw_deg = true\n"),
            "a.robot.toml:2: lidar.yaw_deg is true or false; expected number");
  EXPECT_EQ(refusal_of("[imu]\nrate_hz = [100]\n"),
            "a.robot.toml:2: imu.rate_hz is a list; expected number");
  EXPECT_EQ(refusal_of("[robot]\nname = 7\n"),
            "a.robot.toml:2: robot.name is a whole number; expected text");
  EXPECT_EQ(refusal_of("[raw]\nclock = 1\n"),
            "a.robot.toml:2: raw.clock is a whole number; expected \"data\" or \"event-offset\" or "
            "\"scan-rate\"");
}

TEST(RobotToml, ANumberThatIsNoneOrFitsNowhereIsSaidToBeThat) {
  EXPECT_EQ(refusal_of("[wheels]\n\ntrack_m = nan\n"),
            "a.robot.toml:3: wheels.track_m is not finite; expected a number");
  EXPECT_EQ(refusal_of("[wheels]\ntrack_m = 9223372036854775807\n"),
            "a.robot.toml:2: wheels.track_m is out of range; expected number that a double holds");
}

TEST(RobotToml, ABrokenRuleStandsInTheLineOfItsKey) {
  EXPECT_EQ(refusal_of("[imu]\nx_m = 1\nrate_hz = -1\n[raw]\naccel_lsb_per_g = 0\n"
                       "lidar_angles = \"widdershins\"\n"),
            "a.robot.toml:6: raw.lidar_angles = \"widdershins\"; expected \"clockwise\" or "
            "\"counter-clockwise\"; "
            "a.robot.toml:5: raw.accel_lsb_per_g = 0: expected > 0; "
            "a.robot.toml:3: imu.rate_hz = -1: expected a finite number > 0");
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
}

TEST(RobotToml, AnOverrideKnowsWhichKeysItStates) {
  const auto stated = override_robot(RobotModel{}, "[lidar]\nx_m = 4\nrange_max_m = 12\n", "file");
  ASSERT_TRUE(stated.has_value());
  EXPECT_EQ(stated->keys, (RobotKeys{"lidar.x_m", "lidar.range_max_m"}));
  EXPECT_TRUE(states_any(stated->keys, kLidarPoseKeys));
  EXPECT_FALSE(states_all(stated->keys, kLidarPoseKeys));
  EXPECT_FALSE(states_any(stated->keys, kImuPoseKeys));
}

TEST(RobotToml, AWrittenModelStatesEveryKey) {
  const auto read = robot_from_toml(robot_to_toml(RobotModel{}), "file");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  RobotKeys every;
  for (const RobotEntry& entry : robot_entries(RobotModel{})) every.insert(entry.path());
  EXPECT_EQ(read->keys, every);
}

}  // namespace
}  // namespace corridor::formats
