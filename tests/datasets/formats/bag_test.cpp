// What ROS 1 bags give when they are fit.
#include "datasets/formats/bag/bag.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "datasets/formats/bag/bag_framing.hpp"
#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/bag_support.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::formats {
namespace {

using test::bag_bytes;
using test::odometry_message;
using test::scan_message;
using test::ScratchFolder;
using test::small_bag;
using test::write_bag;
using test::write_text;

constexpr std::int64_t kBegin_ns = 100'000'000'000;
// The angle passes through a quaternion: a few units in the last place of pi.
constexpr double kAngleRoundTrip_rad = 2e-15;

SensorLog without_ticks(SensorLog log) {
  for (SensorEvent& event : log.events) {
    if (auto* sample = std::get_if<WheelSample>(&event)) sample->ticks.reset();
  }
  return log;
}

// Takes over the angles of `log` where they differ by rounding only.
void round_angles(const SensorLog& log, SensorLog& read) {
  for (std::size_t i = 0; i < std::min(read.events.size(), log.events.size()); ++i) {
    auto* sample = std::get_if<WheelSample>(&read.events[i]);
    const auto* original = std::get_if<WheelSample>(&log.events[i]);
    if (sample == nullptr || original == nullptr) continue;
    const Pose2& pose = original->T_odom_base;
    const double difference_rad = sample->T_odom_base.theta_rad() - pose.theta_rad();
    if (std::abs(wrap_angle(difference_rad)) > kAngleRoundTrip_rad) continue;
    sample->T_odom_base =
        Pose2(sample->T_odom_base.x_m(), sample->T_odom_base.y_m(), pose.theta_rad());
  }
}

std::string notes_of(const SensorLog& log) {
  std::string notes;
  for (const std::string& note : log.provenance.notes) notes += note + "\n";
  return notes;
}

TEST(Bag, GivesBackTheLogThatWasWritten) {
  const SensorLog log = without_ticks(test::small_log());
  const ScratchFolder folder;
  ASSERT_TRUE(write_rosbag(log, folder / "a.bag"));
  ReadLogOptions options;
  options.robot = log.robot;
  auto read = read_log(folder / "a.bag", options);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  // Equal stamps: a bag's streams are merged wheels, scans and IMU in the order of their topics.
  const auto order = [](const SensorEvent& a, const SensorEvent& b) {
    return std::pair(stamp_of(a), a.index()) < std::pair(stamp_of(b), b.index());
  };
  SensorLog sorted = log;
  std::stable_sort(sorted.events.begin(), sorted.events.end(), order);
  std::stable_sort(read->events.begin(), read->events.end(), order);
  round_angles(sorted, *read);
  EXPECT_TRUE(test::same_events(*read, sorted));
  EXPECT_EQ(read->provenance.format, "rosbag");
}

RC_GTEST_PROP(Bag, ReadUndoesWriteToTheNanosecond, ()) {
  SensorLog log = without_ticks(test::small_log());
  const auto shift_ns = *rc::gen::inRange<std::int64_t>(0, 4'000'000'000'000'000'000);
  for (SensorEvent& event : log.events) {
    std::visit(
        [&](auto& reading) {
          reading.stamp.nanoseconds += shift_ns;
          using Reading = std::decay_t<decltype(reading)>;
          if constexpr (std::is_same_v<Reading, LaserScan>) {
            for (float& range_m : reading.ranges_m) {
              range_m = static_cast<float>(*rc::gen::inRange(100, 4500)) / 1000.0F;
            }
            std::fill(reading.is_valid.begin(), reading.is_valid.end(), 1);
          }
        },
        event);
  }
  const ScratchFolder folder;
  RC_ASSERT(write_rosbag(log, folder / "a.bag").has_value());
  ReadLogOptions options;
  options.robot = log.robot;
  const auto read = read_log(folder / "a.bag", options);
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->num_scans() == log.num_scans());
  RC_ASSERT(read->num_wheel_samples() == log.num_wheel_samples());
  RC_ASSERT(read->num_imu_samples() == log.num_imu_samples());
  RC_ASSERT(stamp_of(read->events.front()) == stamp_of(log.events.front()));
  RC_ASSERT(stamp_of(read->events.back()) == stamp_of(log.events.back()));
}

TEST(Bag, GivesTheSameEventsInEveryCompression) {
  const ScratchFolder folder;
  write_bag(folder / "none.bag", small_bag(), ros1::Compression::kNone);
  const auto plain = read_log(folder / "none.bag");
  ASSERT_TRUE(plain.has_value()) << plain.error().to_line();
  EXPECT_EQ(plain->num_scans(), 5U);
  EXPECT_EQ(plain->num_wheel_samples(), 21U);
  EXPECT_EQ(plain->num_imu_samples(), 21U);
  for (const auto compression : {ros1::Compression::kBz2, ros1::Compression::kLz4}) {
    write_bag(folder / "a.bag", small_bag(), compression);
    const auto read = read_log(folder / "a.bag");
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_TRUE(test::same_events(*read, *plain));
  }
}

TEST(Bag, CountsTheHeadersStampAndMergesTopicsByIt) {
  // Each scan is recorded 30 ms after its first beam, between odometry of later stamps.
  auto messages = small_bag();
  for (ros1::Message& message : messages) {
    if (message.topic == "/scan") message.record_ns += 30'000'000;
  }
  const ScratchFolder folder;
  write_bag(folder / "late.bag", messages);
  write_bag(folder / "a.bag", small_bag());
  const auto late = read_log(folder / "late.bag");
  ASSERT_TRUE(late.has_value()) << late.error().to_line();
  EXPECT_TRUE(test::same_events(*late, *read_log(folder / "a.bag")));
}

TEST(Bag, KeepsTheOrderOfRecordingOnRequest) {
  auto messages = small_bag();
  messages[3].stamp_ns -= 50'000'000;
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  ASSERT_FALSE(read_log(folder / "a.bag").has_value());
  ReadLogOptions options;
  options.order = StampOrder::kFile;
  const auto read = read_log(folder / "a.bag", options);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->events.size(), messages.size());
  EXPECT_NE(notes_of(*read).find("rows' stamps moved"), std::string::npos);
}

TEST(Bag, TakesTheSensorsLimitsFromItsScans) {
  auto messages = small_bag();
  for (ros1::Message& message : messages) {
    if (auto* scan = std::get_if<ros1::Scan>(&message.content)) scan->time_increment_s = 0.015625F;
  }
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->robot.lidar.range_min_m, 0.125);
  EXPECT_EQ(read->robot.lidar.range_max_m, 4.5);
  EXPECT_EQ(read->robot.lidar.scan_duration_s, 0.0625);
}

TEST(Bag, RangesOutsideTheLimitsAreCountedAsNoReturn) {
  auto messages = small_bag();
  std::get<ros1::Scan>(messages[2].content).ranges_m = {std::numeric_limits<float>::quiet_NaN(),
                                                        std::numeric_limits<float>::infinity(), 0,
                                                        0.0625F, 4.5F};
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  const std::string notes = notes_of(*read);
  for (const char* note :
       {"1 NaN ranges taken as no return", "1 infinite ranges taken as no return",
        "1 beams of range 0 taken as no return", "1 beams below the sensor's minimum"}) {
    EXPECT_NE(notes.find(note), std::string::npos) << note << " in " << notes;
  }
  for (const SensorEvent& event : read->events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) {
      EXPECT_EQ(scan->is_valid, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
      EXPECT_EQ(scan->ranges_m, (std::vector<float>{5.5F, 5.5F, 0, 0.0625F, 4.5F}));
      break;
    }
  }
}

TEST(Bag, WhatMessagesSayAndTheLogDoesNotHoldIsCounted) {
  auto messages = small_bag();
  const ScratchFolder folder;
  for (ros1::Message& message : messages) message.record_ns = message.stamp_ns;
  write_bag(folder / "a.bag", messages);
  const auto bare = read_log(folder / "a.bag");
  ASSERT_TRUE(bare.has_value()) << bare.error().to_line();
  EXPECT_FALSE(bare->provenance.has_left_out) << notes_of(*bare);
  messages[2].record_ns += 1;
  std::get<ros1::Scan>(messages[2].content).intensities = {1, 2, 3, 4, 5};
  write_bag(folder / "a.bag", messages);
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_TRUE(read->provenance.has_left_out);
  for (const char* note :
       {"1 messages lose the time of their recording", "1 scans lose their intensities"}) {
    EXPECT_NE(notes_of(*read).find(note), std::string::npos) << note << " in " << notes_of(*read);
  }
}

TEST(Bag, OfSeveralTopicsTheSidecarNamesOne) {
  auto messages = small_bag();
  ros1::Message rear = scan_message(kBegin_ns);
  rear.topic = "/rear";
  messages.push_back(rear);
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  const auto unnamed = read_log(folder / "a.bag");
  ASSERT_FALSE(unnamed.has_value());
  EXPECT_NE(unnamed.error().to_line().find(
                "2 topics of sensor_msgs/LaserScan; expected topics.scan in LOG.topics.toml: "
                "'/rear' or '/scan'"),
            std::string::npos)
      << unnamed.error().to_line();
  write_text(folder / "a.topics.toml", "[topics]\nscan = \"/scan\"\nimu = \"\"\n");
  const auto named = read_log(folder / "a.bag");
  ASSERT_TRUE(named.has_value()) << named.error().to_line();
  EXPECT_EQ(named->num_scans(), 5U);
  EXPECT_EQ(named->num_imu_samples(), 0U);
  EXPECT_NE(notes_of(*named).find("1 messages of '/rear' ('sensor_msgs/LaserScan') left out"),
            std::string::npos);
  EXPECT_NE(notes_of(*named).find("21 messages of '/imu'"), std::string::npos);
}

TEST(Bag, WheelAnglesBecomeTicksAndPoses) {
  std::vector<ros1::Message> messages;
  for (int step = 0; step <= 10; ++step) {
    const std::int64_t stamp_ns = kBegin_ns + 100'000'000LL * step;
    // A tenth of a turn a step, the wheels opposite: the robot turns on the spot.
    const double angle_rad = 2 * std::numbers::pi * 0.1 * step;
    messages.push_back({"/joints", stamp_ns, stamp_ns,
                        ros1::Joints{{"arm", "R", "L"}, {9, angle_rad, -angle_rad}}});
    if (step % 5 == 0) messages.push_back(scan_message(stamp_ns));
  }
  messages.push_back({"/joints", kBegin_ns, kBegin_ns, ros1::Joints{{"arm"}, {9}}});
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  write_text(folder / "a.topics.toml",
             "[topics]\njoints = \"/joints\"\n"
             "[joints]\nleft = \"L\"\nright = \"R\"\nticks_per_turn = 1000\n");
  ReadLogOptions options;
  options.robot = RobotModel{};
  options.robot->wheels = {0.5, 1e-3, 1e-3, 0.01};
  const auto read = read_log(folder / "a.bag", options);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->num_wheel_samples(), 11U);
  EXPECT_NE(notes_of(*read).find("1 joint messages without both wheels"), std::string::npos);
  const WheelSample* last = nullptr;
  for (const SensorEvent& event : read->events) {
    if (const auto* sample = std::get_if<WheelSample>(&event)) last = sample;
  }
  ASSERT_NE(last, nullptr);
  EXPECT_EQ(last->ticks->left, -1000);
  EXPECT_EQ(last->ticks->right, 1000);
  // 1 m ahead on the right, 1 m back on the left, 0.5 m between: 4 rad.
  EXPECT_NEAR(wrap_angle(last->T_odom_base.theta_rad() - 4), 0, 1e-12);
  EXPECT_NEAR(last->T_odom_base.translation_m().norm(), 0, 1e-12);
}

TEST(Bag, TheFramingListsEveryMessageWithItsByte) {
  const std::string bytes = bag_bytes(small_bag());
  const auto index = check_bag_framing(bytes, "a.bag");
  ASSERT_TRUE(index.has_value()) << index.error().to_line();
  ASSERT_EQ(index->connections.size(), 3U);
  EXPECT_EQ(index->messages.size(), small_bag().size());
  for (const BagMessage& message : index->messages) {
    EXPECT_EQ(bytes.substr(message.origin + 8, 5), "conn=") << message.origin;
  }
}

TEST(Bag, SaysWhatItCannotHold) {
  const SensorLog log = test::small_log();
  const auto losses = losses_of_conversion(log, LogFormat::kRosbag);
  ASSERT_EQ(losses.size(), 2U);  // its angles are exact in 32-bit floats
  EXPECT_NE(losses[0].find("ticks"), std::string::npos);
  EXPECT_NE(losses[1].find("robot model"), std::string::npos);
  SensorLog early = log;
  std::get<ImuSample>(early.events.front()).stamp.nanoseconds = -1;
  const ScratchFolder folder;
  const auto written = write_rosbag(early, folder / "a.bag");
  ASSERT_FALSE(written.has_value());
  EXPECT_NE(written.error().to_line().find("ROS time"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.bag"));
}

TEST(Bag, ARecordedLogKeepsItsStampsRangesAndOdometry) {
  const auto file = testing::recorded_file("recorded/fr079.clf.gz");
  if (!file) GTEST_SKIP() << testing::missing_data_message("recorded/fr079.clf.gz");
  ReadLogOptions options;
  options.no_return_range_m = 81.0;
  const auto log = read_log(*file, options);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  const ScratchFolder folder;
  ASSERT_TRUE(write_rosbag(*log, folder / "fr079.bag"));
  ReadLogOptions as_calibrated;
  as_calibrated.robot = log->robot;
  auto read = read_log(folder / "fr079.bag", as_calibrated);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  ASSERT_EQ(read->events.size(), log->events.size());
  round_angles(*log, *read);
  // Angles of beams are 32-bit floats in a bag; everything else is exact.
  constexpr double kFloatRounding_rad = 1e-6;
  for (std::size_t i = 0; i < read->events.size(); ++i) {
    auto* scan = std::get_if<LaserScan>(&read->events[i]);
    const auto* original = std::get_if<LaserScan>(&log->events[i]);
    if (scan == nullptr || original == nullptr) continue;
    ASSERT_NEAR(scan->angle_min_rad, original->angle_min_rad, kFloatRounding_rad);
    ASSERT_NEAR(scan->angle_rad(scan->num_beams()), original->angle_rad(scan->num_beams()),
                kFloatRounding_rad * static_cast<double>(scan->num_beams()));
    scan->angle_min_rad = original->angle_min_rad;
    scan->angle_increment_rad = original->angle_increment_rad;
  }
  EXPECT_TRUE(test::same_events(*read, *log));
}

TEST(BagTopics, ListsEveryViolationWithItsLine) {
  const auto topics = bag_topics_from_toml(
      "speed = 1\n[topics]\nscan = 1\nodometry = \"/odom\"\njoints = \"/j\"\nlidar = \"/x\"\n"
      "[joints]\nleft = \"a\"\nright = \"a\"\nticks_per_turn = 0\n",
      "t.toml");
  ASSERT_FALSE(topics.has_value());
  EXPECT_EQ(topics.error().to_line(),
            "t.toml:1: unknown key speed; expected one of topics joints; "
            "t.toml:6: unknown key topics.lidar; expected one of scan odometry imu joints; "
            "t.toml:3: topics.scan is a whole number; expected text; "
            "t.toml:7: joints: expected the names of two joints, left and right; "
            "t.toml:10: joints.ticks_per_turn: expected a whole number from 1 to 16777216; "
            "t.toml:5: topics.joints: wheels come from joints or from odometry, not from both");
  const auto without_topic = bag_topics_from_toml("\n[joints]\nleft = \"a\"\n", "t.toml");
  ASSERT_FALSE(without_topic.has_value());
  EXPECT_EQ(without_topic.error().to_line(), "t.toml:2: topics.joints: missing");
  const auto without_joints = bag_topics_from_toml("[topics]\njoints = 3\n", "t.toml");
  ASSERT_FALSE(without_joints.has_value());
  EXPECT_EQ(without_joints.error().to_line(),
            "t.toml:2: topics.joints is a whole number; expected text");
  EXPECT_FALSE(bag_topics_from_toml("[topics", "t.toml").has_value());
}

TEST(BagTopics, ANumberOfTicksThatIsAFractionIsSaidToBeThat) {
  const auto topics = bag_topics_from_toml(
      "[topics]\njoints = \"/j\"\n[joints]\nleft = \"a\"\nright = \"b\"\nticks_per_turn = 0.5\n",
      "t.toml");
  ASSERT_FALSE(topics.has_value());
  EXPECT_EQ(topics.error().to_line(),
            "t.toml:6: joints.ticks_per_turn is a floating-point number; expected integer");
}

TEST(BagTopics, ATextWithoutAKeyIsRefused) {
  for (const char* text : {"", "# nothing yet\n", "[topics]\n"}) {
    const auto topics = bag_topics_from_toml(text, "t.toml");
    ASSERT_FALSE(topics.has_value()) << text;
    EXPECT_EQ(topics.error().to_line(), "t.toml: states nothing; expected at least one key");
  }
}

}  // namespace
}  // namespace corridor::formats
