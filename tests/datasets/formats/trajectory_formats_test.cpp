#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/formats/trajectories/trajectory_io.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::ScratchFolder;
using test::write_text;

// The angle passes through sine and cosine: a few units in the last place of pi.
constexpr double kAngleRoundTrip_rad = 2e-15;

// Steps of a millisecond and some nanoseconds; poses with no short decimal form.
Trajectory any_trajectory(const std::vector<std::tuple<int, int, int>>& steps) {
  Trajectory trajectory;
  std::int64_t stamp_ns = -3'000'000'001;
  for (const auto& [dx, dy, dtheta] : steps) {
    stamp_ns += 1'000'001 + std::abs(static_cast<std::int64_t>(dx));
    RC_ASSERT(trajectory.append({{stamp_ns}, Pose2(dx / 7.0, dy / 3e3, dtheta / 1e1), {}}));
  }
  return trajectory;
}

void expect_same(const Trajectory& a, const Trajectory& b, double tolerance_rad) {
  RC_ASSERT(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pose2& p = a[i].T_map_base;
    const Pose2& q = b[i].T_map_base;
    RC_ASSERT(a[i].stamp == b[i].stamp);
    RC_ASSERT(p.x_m() == q.x_m());
    RC_ASSERT(p.y_m() == q.y_m());
    RC_ASSERT(std::abs(wrap_angle(p.theta_rad() - q.theta_rad())) <= tolerance_rad);
  }
}

RC_GTEST_PROP(Kitti, ReadUndoesWriteWithItsTimes, (std::vector<std::tuple<int, int, int>> steps)) {
  const Trajectory trajectory = any_trajectory(steps);
  const auto read =
      parse_kitti(kitti_text(trajectory), "t.kitti", times_text(trajectory), "t.times");
  RC_ASSERT(read.has_value());
  expect_same(read->trajectory, trajectory, kAngleRoundTrip_rad);
}

RC_GTEST_PROP(Euroc, ReadUndoesWrite, (std::vector<std::tuple<int, int, int>> steps)) {
  const Trajectory trajectory = any_trajectory(steps);
  const auto read = parse_euroc(euroc_text(trajectory), "t.csv");
  RC_ASSERT(read.has_value());
  expect_same(read->trajectory, trajectory, kAngleRoundTrip_rad);
}

RC_GTEST_PROP(CarmenTrajectory, ReadUndoesWriteExactly,
              (std::vector<std::tuple<int, int, int>> steps)) {
  const Trajectory trajectory = any_trajectory(steps);
  const auto read = parse_carmen_trajectory(carmen_trajectory_text(trajectory), "t.clf");
  RC_ASSERT(read.has_value());
  expect_same(read->trajectory, trajectory, 0);
}

TEST(TrajectoryFormats, EachFileHoldsItsOwnLayout) {
  Trajectory trajectory;
  ASSERT_TRUE(trajectory.append({{1'500'000'000}, Pose2(2, -3, 0), {}}));
  const ScratchFolder folder;
  for (const char* name : {"t.tum", "t.kitti", "t.csv", "t.clf", "t.clf.gz"}) {
    ASSERT_TRUE(write_trajectory(trajectory, folder / name)) << name;
    const auto read = read_trajectory(folder / name);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_EQ(read->trajectory[0].T_map_base, Pose2(2, -3, 0)) << name;
    EXPECT_EQ(read->trajectory[0].stamp, Timestamp{1'500'000'000}) << name;
    EXPECT_TRUE(read->notes.empty()) << name;
  }
  EXPECT_EQ(read_text(folder / "t.kitti"), "1 -0 0 2 0 1 0 -3 0 0 1 0\n");
  EXPECT_EQ(read_text(folder / "t.times"), "1.500000000\n");
  EXPECT_NE(read_text(folder / "t.csv").find("\n1500000000,2,-3,0,1,0,0,0\n"), std::string::npos);
  EXPECT_NE(read_text(folder / "t.clf")
                .find("\nFLASER 0 2 -3 0 2 -3 0 1.500000000 corridor-bench 1.500000000\n"),
            std::string::npos);
}

TEST(TrajectoryFormats, KittisMatrixTurnsAsThePoseDoes) {
  const double quarter_rad = std::numbers::pi / 2;
  const auto read = parse_kitti("0 -1 0 5 1 0 0 6 0 0 1 0.5\n", "t.kitti", "1\n", "t.times");
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->trajectory[0].T_map_base.theta_rad(), quarter_rad, 1e-12);
  EXPECT_EQ(read->trajectory[0].T_map_base.translation_m(), Eigen::Vector2d(5, 6));
  EXPECT_EQ(read->notes, std::vector<std::string>{"1 heights left out"});
}

TEST(TrajectoryFormats, HeightsOfATumFileAreCounted) {
  const auto read = parse_tum_trajectory("1 2 3 4 0 0 0 1\n2 2 3 0 0 0 0 1\n", "t.tum");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->notes, std::vector<std::string>{"1 heights left out"});
}

TEST(TrajectoryFormats, EurocsGroundTruthLosesItsVelocitiesWithANote) {
  const auto read = parse_euroc(
      "#timestamp, p_RS_R_x [m]\n1403636580838555648,4.5,-1.5,0.5,1,0,0,0,0,0,0,0,0,0,0,0,0\n",
      "t.csv");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->trajectory[0].stamp, Timestamp{1403636580838555648});
  EXPECT_EQ(read->notes, (std::vector<std::string>{"1 heights left out",
                                                   "1 velocities with their biases left out"}));
}

TEST(TrajectoryFormats, ACarmenLogGivesItsCorrectedPoses) {
  const auto read = parse_carmen_trajectory(
      "PARAM robot x\nODOM 9 9 9 0 0 0 1 h 1\n"
      "FLASER 2 1.0 1.5 1 2 0.5 7 8 0.25 10.5 h 0.1\n"
      "ROBOTLASER1 0 0 1 1 9 0 0 1 1.0 0 0 0 0 5 5 5 0 0 0 0 0 11 h 11\n",
      "t.clf");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  ASSERT_EQ(read->trajectory.size(), 1U);
  EXPECT_EQ(read->trajectory[0].T_map_base, Pose2(1, 2, 0.5));
  EXPECT_EQ(read->trajectory[0].stamp, Timestamp{10'500'000'000});
  EXPECT_EQ(read->notes,
            (std::vector<std::string>{"1 ODOM lines left out", "1 PARAM lines left out",
                                      "1 ROBOTLASER1 lines left out"}));
  const auto robot = parse_carmen_trajectory(
      "ROBOTLASER1 0 0 1 1 9 0 0 1 1.0 1 7 3 2 1 5 6 0.5 0 0 0 0 0 11 h 11\n", "t.clf");
  ASSERT_TRUE(robot.has_value()) << robot.error().to_line();
  EXPECT_EQ(robot->trajectory[0].T_map_base, Pose2(5, 6, 0.5));
}

struct Defect {
  std::string line;
  std::string message;
};

void expect_refused(const Result<ReadTrajectory>& read, const std::string& where,
                    const Defect& defect) {
  ASSERT_FALSE(read.has_value()) << defect.line;
  const std::string line = read.error().to_line();
  EXPECT_EQ(line.find(where), 0U) << line;
  EXPECT_NE(line.find(defect.message), std::string::npos) << line;
  EXPECT_NE(line.find("; expected "), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

TEST(Euroc, AnswersEachDefectWithItsLine) {
  const std::vector<Defect> defects = {
      {"2000000000,0,0,0,1,0,0", "7 fields"},
      {"2000000000,0,0,0,1,0,0,0,0", "9 fields"},
      {"2000000000 0 0 0 1 0 0 0", "1 fields"},
      {"2000000000,nan,0,0,1,0,0,0", "'nan'"},
      {"2000000000,,0,0,1,0,0,0", "field ''"},
      {"2000000000,1 2,0,0,1,0,0,0", "'1 2'"},
      {"2000000000,0,0,0,0,0,0,0", "quaternion of length 0"},
      {"2000000000,0,0,0,0.8,0.6,0,0", "roll or pitch"},
      {"1000000000,0,0,0,1,0,0,0", "not later"},
      {"999999999,0,0,0,1,0,0,0", "not later"},
      {"2.5,0,0,0,1,0,0,0", "stamp '2.5'"},
      {"99999999999999999999,0,0,0,1,0,0,0", "stamp '99999999999999999999'"},
      {"4600000000000000001,0,0,0,1,0,0,0", "stamp '4600000000000000001'"},
  };
  for (const Defect& defect : defects) {
    expect_refused(parse_euroc("1000000000,0,0,0,1,0,0,0\n" + defect.line + "\n", "t.csv"),
                   "t.csv:2: ", defect);
  }
}

TEST(Kitti, AnswersEachDefectWithItsLine) {
  const std::vector<Defect> defects = {
      {"1 0 0 0 0 1 0 0 0 0 1", "11 fields"},         {"1 0 0 0 0 1 0 0 0 0 1 0 0", "13 fields"},
      {"1 0 0 inf 0 1 0 0 0 0 1 0", "'inf'"},         {"0 0 0 0 0 0 0 0 0 0 0 0", "no rotation"},
      {"1 0 0 0 0 1 0 0 0 0 -1 0", "no rotation"},    {"1 0 0 0 0 0 -1 0 0 1 0 0", "roll or pitch"},
      {"1 0 0 0 0 -1 0 0 0 0 -1 0", "roll or pitch"},
  };
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  for (const Defect& defect : defects) {
    expect_refused(parse_kitti(good + defect.line + "\n", "t.kitti", "1\n2\n", "t.times"),
                   "t.kitti:2: ", defect);
  }
  for (const Defect& defect : std::vector<Defect>{{"x", "stamp 'x'"},
                                                  {"1", "not later"},
                                                  {"0.5", "not later"},
                                                  {"1 2", "2 fields"},
                                                  {"2\n3", "a stamp more than 2 in t.kitti"}}) {
    const std::string where = defect.line == "2\n3" ? "t.times:3: " : "t.times:2: ";
    expect_refused(parse_kitti(good + good, "t.kitti", "1\n" + defect.line + "\n", "t.times"),
                   where, defect);
  }
  expect_refused(parse_kitti(good + good, "t.kitti", "1\n", "t.times"),
                 "t.kitti:2: ", {"", "a pose more than 1 in t.times"});
}

TEST(Kitti, WithoutStampsIsRefused) {
  const ScratchFolder folder;
  write_text(folder / "t.kitti", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto read = read_trajectory(folder / "t.kitti");
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().to_line().find("has no stamps"), std::string::npos);
  EXPECT_NE(read.error().expected.find("t.times"), std::string::npos);
}

TEST(CarmenTrajectory, NotesHeadingsThatLookLikeDegrees) {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    text += "FLASER 0 0 0 " + std::to_string(9 * i) + " 0 0 0 " + std::to_string(i) + " h 0\n";
  }
  const auto read = parse_carmen_trajectory(text, "a.clf");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->notes,
            std::vector<std::string>{"19 of 20 angles are beyond 2 pi: degrees for radians?"});
}

TEST(CarmenTrajectory, AnswersEachDefectWithItsLine) {
  const std::vector<Defect> defects = {
      {"FLASER 0 0 0 0 0 0 0 2 h", "10 fields"},
      {"FLASER 1 0 0 0 0 0 0 2 h 2", "11 fields"},
      {"FLASER 0 0 0 0 0 0 0 2 h 2 2", "12 fields"},
      {"FLASER 4000000000 0 0 0 0 0 0 2 h 2", "number of ranges '4000000000'"},
      {"FLASER", "number of ranges missing"},
      {"FLASER 0 nan 0 0 0 0 0 2 h 2", "'nan'"},
      {"FLASER 0 0 0 0 0 0 0 1 h 2", "not later"},
      {"FLASER 0 0 0 0 0 0 0 0.5 h 2", "not later"},
      {"FLASER 0 0 0 0 0 0 0 two h 2", "stamp 'two'"},
      {"GARBAGE 1", "'GARBAGE'"},
      {"ODOM 0 0 0 0 0 0 1 h 1 FLASER 0 0 0 0 0 0 0 2 h 2", "FLASER within a line"},
  };
  for (const Defect& defect : defects) {
    expect_refused(
        parse_carmen_trajectory("FLASER 0 0 0 0 0 0 0 1 h 1\n" + defect.line + "\n", "t.clf"),
        "t.clf:2: ", defect);
  }
}

TEST(TrajectoryFormats, StampsOfAnotherUnitAreRefused) {
  std::string tum_ms;
  std::string euroc_ms;
  std::string euroc_s;
  for (int i = 1; i <= 6; ++i) {
    tum_ms += std::to_string(100'000 * i) + " 0 0 0 0 0 0 1\n";
    euroc_ms += std::to_string(100 * i) + ",0,0,0,1,0,0,0\n";
    euroc_s += std::to_string(1'000'000'000LL * 100 * i) + ",0,0,0,1,0,0,0\n";
  }
  expect_refused(parse_euroc(euroc_ms, "t.csv"), "t.csv: ", {"", "median step"});
  expect_refused(parse_euroc(euroc_s, "t.csv"), "t.csv: ", {"", "median step"});
  const auto tum = parse_tum(tum_ms, "t.tum");
  ASSERT_FALSE(tum.has_value());
  EXPECT_NE(tum.error().to_line().find("stamps in seconds"), std::string::npos);
  // Unix time in milliseconds does not even fit.
  EXPECT_FALSE(parse_tum("1600000000000 0 0 0 0 0 0 1\n", "t.tum").has_value());
}

TEST(TrajectoryFormats, AFileWithoutPosesIsRefused) {
  const ScratchFolder folder;
  for (const char* name : {"t.tum", "t.kitti", "t.csv", "t.clf"}) {
    write_text(folder / name, "");
    write_text(folder / "t.times", "");
    const auto read = read_trajectory(folder / name);
    ASSERT_FALSE(read.has_value()) << name;
    EXPECT_NE(read.error().to_line().find("no pose"), std::string::npos);
  }
}

TEST(TrajectoryFormats, SayWhatTheyCannotHold) {
  Trajectory trajectory;
  ASSERT_TRUE(trajectory.append({{1}, Pose2(1, 2, 0), Pose2::Matrix::Identity()}));
  ASSERT_TRUE(trajectory.append({{2}, Pose2(1, 2, 0.1), {}}));
  EXPECT_EQ(losses_of_conversion(trajectory, TrajectoryFormat::kCarmen),
            std::vector<std::string>{"1 covariances"});
  EXPECT_EQ(losses_of_conversion(trajectory, TrajectoryFormat::kTum).size(), 2U);
  const auto kitti = losses_of_conversion(trajectory, TrajectoryFormat::kKitti);
  ASSERT_EQ(kitti.size(), 3U);
  EXPECT_NE(kitti[1].find("2 stamps"), std::string::npos);
}

TEST(TrajectoryFormats, ARecordedLogGivesAPosePerScan) {
  const auto file = testing::recorded_file("recorded/fr079.clf.gz");
  if (!file) GTEST_SKIP() << testing::missing_data_message("recorded/fr079.clf.gz");
  const auto read = read_trajectory(*file);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->trajectory.size(), 4934U);
}

}  // namespace
}  // namespace corridor::formats
