#include "datasets/formats/lidar_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::same_events;
using test::small_log;

constexpr double kOffset_s = 0.0307;
constexpr std::int64_t kOffset_ns = 30'700'000;

// The small log, with one true pose and one relation per scan, on one clock.
struct Recording {
  SensorLog log = small_log();
  std::vector<Relation> relations;

  Recording() {
    log.truth.emplace();
    std::optional<Timestamp> last;
    for (const SensorEvent& event : log.events) {
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      EXPECT_TRUE(log.truth->append({scan->stamp, Pose2(to_seconds(scan->stamp), 0, 0), {}}));
      if (last) relations.push_back({*last, scan->stamp, Pose2(0.1, 0, 0)});
      last = scan->stamp;
    }
  }

  // The same as a LiDAR whose clock is ahead by `offset_s` gives it.
  void delay(double offset_s) {
    for (SensorEvent& event : log.events) {
      if (auto* scan = std::get_if<LaserScan>(&event)) {
        scan->stamp = add_seconds(scan->stamp, offset_s);
      }
    }
    std::stable_sort(log.events.begin(), log.events.end(),
                     [](const auto& a, const auto& b) { return stamp_of(a) < stamp_of(b); });
    Trajectory truth;
    for (TrajectoryPose pose : log.truth->poses()) {
      pose.stamp = add_seconds(pose.stamp, offset_s);
      EXPECT_TRUE(truth.append(pose));
    }
    log.truth = truth;
    for (Relation& relation : relations) {
      relation.t1 = add_seconds(relation.t1, offset_s);
      relation.t2 = add_seconds(relation.t2, offset_s);
    }
    log.robot.lidar.time_offset_s = offset_s;
  }
};

std::vector<Timestamp> stamps_of(const Trajectory& trajectory) {
  std::vector<Timestamp> stamps;
  for (const TrajectoryPose& pose : trajectory.poses()) stamps.push_back(pose.stamp);
  return stamps;
}

bool has_note(const SensorLog& log, const std::string& part) {
  for (const std::string& note : log.provenance.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(LidarClock, OfALogThatWasDelayedGivesBackTheLogBefore) {
  for (const double offset_s : {kOffset_s, -kOffset_s, 1.4e9}) {
    const Recording before;
    Recording recording;
    recording.delay(offset_s);
    EXPECT_EQ(move_onto_wheel_clock(recording.log, &recording.relations), offset_s);
    EXPECT_TRUE(same_events(recording.log, before.log)) << offset_s;
    EXPECT_EQ(stamps_of(*recording.log.truth), stamps_of(*before.log.truth));
    EXPECT_EQ(recording.relations, before.relations);
    EXPECT_EQ(recording.log.robot.lidar.time_offset_s, 0);
    EXPECT_TRUE(has_note(recording.log, "onto the wheels' clock"));
    EXPECT_TRUE(defects(recording.log).empty());
  }
}

TEST(LidarClock, IsNotMovedTwice) {
  Recording recording;
  recording.delay(kOffset_s);
  move_onto_wheel_clock(recording.log, &recording.relations);
  const SensorLog once = recording.log;
  EXPECT_EQ(move_onto_wheel_clock(recording.log, &recording.relations), 0);
  EXPECT_TRUE(same_events(recording.log, once));
  EXPECT_EQ(recording.log.provenance.notes, once.provenance.notes);
}

TEST(LidarClock, TruthAndRelationsOfAnotherClockStayWithANote) {
  Recording recording;
  recording.log.robot.lidar.time_offset_s = kOffset_s;
  // A motion capture system that samples between the scans.
  Trajectory truth;
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(truth.append({Timestamp{7'000'000LL + 13'000'000LL * i}, Pose2(), {}}));
  }
  recording.log.truth = truth;
  recording.relations = {{Timestamp{7'000'000}, Timestamp{20'000'000}, Pose2()}};
  const std::vector<Relation> relations = recording.relations;
  move_onto_wheel_clock(recording.log, &recording.relations);
  EXPECT_EQ(stamps_of(*recording.log.truth), stamps_of(truth));
  EXPECT_EQ(recording.relations, relations);
  EXPECT_TRUE(has_note(recording.log, "true poses have other stamps"));
  EXPECT_TRUE(has_note(recording.log, "relations have other stamps"));
}

TEST(LidarClock, TruthRoundedToAMicrosecondStillCarriesTheScansStamps) {
  Recording recording;
  recording.delay(kOffset_s);
  Trajectory rounded;
  for (TrajectoryPose pose : recording.log.truth->poses()) {
    pose.stamp.nanoseconds += 400;
    EXPECT_TRUE(rounded.append(pose));
  }
  recording.log.truth = rounded;
  move_onto_wheel_clock(recording.log, nullptr);
  EXPECT_EQ(recording.log.truth->front().stamp.nanoseconds,
            rounded.front().stamp.nanoseconds - kOffset_ns);
}

TEST(LidarClock, OfALogWithoutScansOrEventsMovesNothing) {
  SensorLog log;
  log.robot.lidar.time_offset_s = kOffset_s;
  EXPECT_EQ(move_onto_wheel_clock(log, nullptr), kOffset_s);
  EXPECT_TRUE(log.events.empty());
  EXPECT_EQ(log.robot.lidar.time_offset_s, 0);
}

}  // namespace
}  // namespace corridor::formats
