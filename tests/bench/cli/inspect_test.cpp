// `data inspect`: what it says of a log's robot model, and of whole logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/catalog/sha256.hpp"
#include "tests/bench/cli/program.hpp"

namespace corridor::testing {
namespace {

constexpr const char* kLog =
    "FLASER 4 1 1 1 1 0 0 0 0 0 0 1.0 host 1.0\n"
    "FLASER 4 1 1 1 2 0.1 0 0 0.1 0 0 1.1 host 1.1\n";

// The lines of the robot model in an answer, without what is around them.
std::string robot_model_of(const Answer& answer) {
  const std::size_t begin = answer.out.find("robot model:\n");
  const std::size_t end = answer.out.find("\nnote: ", begin);
  return begin == std::string::npos ? answer.out : answer.out.substr(begin, end - begin);
}

TEST(Inspect, OfALogWithoutCalibrationCallsItsRobotAssumed) {
  const ScratchFolder folder;
  folder.write("a.clf", kLog);
  const std::string robot = robot_model_of(run_program(folder, "data inspect a.clf"));
  EXPECT_EQ(robot,
            "robot model:\n"
            "  [robot]\n"
            "  name = 'robot'  # assumed\n"
            "  [wheels]\n"
            "  track_m = 0.35  # assumed\n"
            "  left_m_per_tick = 0.0001  # assumed\n"
            "  right_m_per_tick = 0.0001  # assumed\n"
            "  sigma_m_per_sqrt_m = 0.01  # assumed\n"
            "  [lidar]\n"
            "  x_m = 0.0  # assumed\n"
            "  y_m = 0.0  # assumed\n"
            "  yaw_deg = 0.0  # assumed\n"
            "  range_min_m = 0.05  # assumed\n"
            "  range_max_m = 81.0  # assumed\n"
            "  range_sigma_m = 0.02  # assumed\n"
            "  scan_duration_s = 0.0  # assumed\n"
            "  time_offset_s = 0.0  # assumed\n"
            "  [imu]\n"
            "  x_m = 0.0  # assumed\n"
            "  y_m = 0.0  # assumed\n"
            "  yaw_deg = 0.0  # assumed\n"
            "  rate_hz = 100.0  # assumed\n"
            "  gyro_noise_radps = 0.01  # assumed\n"
            "  accel_noise_mps2 = 0.05  # assumed\n"
            "  gyro_bias_walk_radps_sqrt_s = 0.0001  # assumed\n"
            "  accel_bias_walk_mps2_sqrt_s = 0.001  # assumed");
  const auto report = nlohmann::json::parse(run_program(folder, "data inspect a.clf --json").out);
  std::size_t num_values = 0;
  for (const auto& table : report.at("robot_model")) num_values += table.size();
  EXPECT_EQ(report.at("assumed").size(), num_values);
  EXPECT_EQ(report.at("assumed").front(), "robot.name");
}

TEST(Inspect, DoesNotCallAssumedWhatLogRobotTomlStates) {
  const ScratchFolder folder;
  folder.write("a.clf", kLog);
  folder.write("a.robot.toml", "[wheels]\ntrack_m = 0.35\n[lidar]\nx_m = 0.1\nrange_max_m = 50\n");
  const std::string robot = robot_model_of(run_program(folder, "data inspect a.clf"));
  for (const char* part : {"\n  track_m = 0.35\n", "\n  left_m_per_tick = 0.0001  # assumed\n",
                           "\n  x_m = 0.1\n", "\n  range_max_m = 50.0\n"}) {
    EXPECT_NE(robot.find(part), std::string::npos) << part << " in " << robot;
  }
  const auto report = nlohmann::json::parse(run_program(folder, "data inspect a.clf --json").out);
  const auto assumed = report.at("assumed").get<std::vector<std::string>>();
  const auto is_assumed = [&](const char* path) {
    return std::count(assumed.begin(), assumed.end(), path) == 1;
  };
  EXPECT_FALSE(is_assumed("wheels.track_m"));
  EXPECT_FALSE(is_assumed("lidar.range_max_m"));
  EXPECT_TRUE(is_assumed("wheels.left_m_per_tick"));
  EXPECT_FALSE(is_assumed("lidar.x_m"));
  EXPECT_TRUE(is_assumed("lidar.y_m"));
}

TEST(Inspect, DoesNotCallAssumedWhatTheCatalogueStates) {
  const ScratchFolder folder;
  folder.write("data/a.clf", kLog);
  folder.write("data/catalog.toml",
               "[[dataset]]\nname = \"mine\"\ntitle = \"A log\"\nformat = \"carmen\"\n"
               "files = [{ path = \"a.clf\", sha256 = \"" +
                   catalog::to_hex(catalog::sha256_of(kLog)) +
                   "\" }]\ntruth = \"none\"\norder = \"stamp\"\nlicence = \"none stated\"\n"
                   "source = \"a test\"\nnot_fetchable = \"made here\"\n"
                   "no_return_range_m = 50\ncalibration.wheels.track_m = 0.33\n");
  const Answer answer = run_program(folder, "data inspect mine --data-dir data");
  for (const char* part : {"\n  track_m = 0.33\n", "\n  range_max_m = 50.0\n",
                           "\n  left_m_per_tick = 0.0001  # assumed\n"}) {
    EXPECT_NE(answer.out.find(part), std::string::npos) << part << " in " << answer.out;
  }
}

TEST(Inspect, ACalibrationThatIsWrongIsRefusedWithItsLine) {
  const ScratchFolder folder;
  folder.write("a.clf", kLog);
  folder.write("a.robot.toml", "[wheels]\ntrack_m = \"0.35\"\n");
  const Answer answer = run_program(folder, "data inspect a.clf");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_EQ(answer.num_error_lines(), 1) << answer.err;
  EXPECT_NE(answer.err.find("a.robot.toml:2: wheels.track_m is a text; expected number\n"),
            std::string::npos)
      << answer.err;
}

TEST(Inspect, OfASimulatedLogKnowsItsTruthAndFindsTheGyroInAgreement) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  const Answer answer = run_program(folder, "data inspect a.rawlog --json");
  ASSERT_EQ(answer.exit_code, 0) << answer.err << answer.out;
  const auto report = nlohmann::json::parse(answer.out);
  EXPECT_EQ(report.at("suspicions").size(), 0U) << report.at("suspicions").dump();
  EXPECT_EQ(report.at("truth").at("scans_with_pose_ratio"), 1.0);
  EXPECT_NEAR(report.at("truth").at("path_m").get<double>(),
              report.at("wheels").at("path_m").get<double>(),
              0.1 * report.at("truth").at("path_m").get<double>());
}

}  // namespace
}  // namespace corridor::testing
