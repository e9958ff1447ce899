#include "bench/runner/systems.hpp"

#include <gtest/gtest.h>

#include <set>

#include "bench/runner/back_ends.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::runner {
namespace {

TEST(Systems, AreAllMadeWithEveryProfileAndAnswerToTheirName) {
  for (const SystemInfo& info : systems()) {
    EXPECT_FALSE(info.description.empty()) << info.name;
    ASSERT_FALSE(info.profiles.empty()) << info.name;
    for (const ProfileInfo& profile : info.profiles) {
      if (info.takes_graphs()) {
        EXPECT_TRUE(info.graph_task(profile.name, {}).has_value()) << info.name;
        continue;
      }
      const auto system = info.make({profile.name, {}, info.default_backend, RobotModel{}, 1, 1});
      ASSERT_TRUE(system.has_value()) << info.name << ": " << system.error().to_line();
      EXPECT_EQ((*system)->name(), info.name);
    }
  }
}

TEST(Systems, AreMadeWithEveryBackEndIfTheyTakeOne) {
  for (const SystemInfo& info : systems()) {
    if (!info.default_backend) continue;
    EXPECT_TRUE(check_back_end(*info.default_backend)) << info.name;
    if (info.takes_graphs()) continue;
    for (const BackEndInfo& back_end : back_ends()) {
      EXPECT_TRUE(info.make({info.profiles.front().name, {}, back_end.name, RobotModel{}, 1, 1})
                      .has_value());
    }
    EXPECT_FALSE(
        info.make({info.profiles.front().name, {}, "magic", RobotModel{}, 1, 1}).has_value());
  }
}

TEST(BackEnds, AnswerToTheirNameAndHaveParametersWithMeanings) {
  for (const BackEndInfo& info : back_ends()) {
    const auto made = make_back_end(info.name, {});
    ASSERT_TRUE(made.has_value()) << info.name;
    EXPECT_EQ((*made)->name(), info.name.substr(0, info.name.find('@')));
    EXPECT_FALSE(info.parameters.empty()) << info.name;
    for (const ParamRow& row : info.parameters) {
      EXPECT_FALSE(row.meaning.empty()) << info.name << "." << row.name;
    }
  }
}

TEST(BackEnds, TakeParametersSetByHand) {
  EXPECT_TRUE(make_back_end("gauss-newton", {}, {{"linear", "cholmod"}}));
  const auto refused = make_back_end("fixed-lag", {}, {{"wildfir", "1"}, {"lag", "0"}});
  ASSERT_FALSE(refused.has_value());
  const std::string line = refused.error().to_line();
  for (const char* part : {"back-end fixed-lag", "unknown parameter wildfir (nearest: wildfire",
                           "lag = 0: expected 1 to", "list backends --json"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  // The name decides the method.
  EXPECT_FALSE(make_back_end("gauss-newton", {}, {{"use_damping", "true"}}));
}

TEST(Systems, HaveNamesOfTheirOwnAndParametersWithMeanings) {
  std::set<std::string> names;
  for (const SystemInfo& info : systems()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    for (const ParamRow& row : info.param_table(info.profiles.front().name)) {
      EXPECT_FALSE(row.meaning.empty()) << info.name << "." << row.name;
    }
  }
}

TEST(Systems, ResolveEveryParameterAndRefuseUnknownOnes) {
  const SystemInfo karto = *find_system("karto");
  const auto values = karto.resolve("as-shipped", {{"buffer_size_scans", "5"}});
  ASSERT_TRUE(values.has_value());
  EXPECT_EQ(values->at("buffer_size_scans"), "5");
  EXPECT_EQ(values->size(), karto.param_table("as-shipped").size());
  EXPECT_NE(karto.resolve("as-shipped", {})->at("count_no_returns"),
            karto.resolve("corrected", {})->at("count_no_returns"));
  EXPECT_FALSE(karto.resolve("as-shipped", {{"speed", "5"}}).has_value());
  EXPECT_FALSE(karto.resolve("nope", {}).has_value());
}

// Of the others the scans alone make a path: a system that stays at the origin has to say so.
TEST(Systems, ThatNeedNoWheelsFollowADriveWithoutThem) {
  const SensorLog log = testing::room_log({.num_scans = 40});
  for (const SystemInfo& info : systems()) {
    if (info.needs_wheels || info.needs_imu || info.takes_graphs()) continue;
    const auto system =
        *info.make({info.profiles.front().name, {}, info.default_backend, log.robot, 1, 1});
    for (const SensorEvent& event : log.events) {
      if (std::holds_alternative<WheelSample>(event)) continue;
      ASSERT_TRUE(system->step(event).has_value()) << info.name;
    }
    const auto estimate = system->finish();
    ASSERT_TRUE(estimate.has_value()) << info.name << ": " << estimate.error().to_line();
    // On the other side of the room, 3.2 m away.
    const Pose2 T_map_base = estimate->trajectory[20].T_map_base;
    const Pose2 true_T_map_base = (*log.truth)[20].T_map_base;
    EXPECT_LT((T_map_base.translation_m() - true_T_map_base.translation_m()).norm(), 0.3)
        << info.name;
  }
}

TEST(Systems, SayWhichSensorTheyMiss) {
  const auto missing = [](const char* name, const LogSensors& sensors) {
    return missing_sensor(*find_system(name), sensors).value_or("nothing");
  };
  const LogSensors no_wheels{.has_wheels = false}, no_imu{.has_imu = false};
  EXPECT_EQ(missing("dead-reckoning", no_wheels), "wheels");
  EXPECT_EQ(missing("dead-reckoning", no_imu), "nothing");
  EXPECT_EQ(missing("dead-reckoning-gyro", no_wheels), "wheels");
  EXPECT_EQ(missing("dead-reckoning-gyro", no_imu), "an IMU");
  EXPECT_EQ(missing("fusion-paper", no_imu), "an IMU");
  EXPECT_EQ(missing("fusion", {false, false}), "nothing");
}

TEST(SystemChoice, ReadsNamesWithAndWithoutAProfile) {
  EXPECT_EQ(parse_system_choice("karto").value(), (SystemChoice{"karto", "as-shipped"}));
  EXPECT_EQ(parse_system_choice("karto@corrected").value(), (SystemChoice{"karto", "corrected"}));
  EXPECT_EQ(parse_system_choice("karto@").error().what, "unknown profile \"\" of system karto");
  EXPECT_NE(parse_system_choice("Karto").error().expected.find("karto"), std::string::npos);
}

}  // namespace
}  // namespace corridor::runner
