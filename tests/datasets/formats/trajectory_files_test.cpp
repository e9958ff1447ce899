#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::ScratchFolder;
using test::write_text;

// The angle passes through a quaternion: a few units in the last place of pi.
constexpr double kAngleRoundTrip_rad = 2e-15;

RC_GTEST_PROP(Tum, ReadUndoesWrite, (std::vector<std::tuple<int, int, int>> steps)) {
  Trajectory trajectory;
  std::int64_t stamp_ns = -3'000'000'001;
  for (const auto& [dx, dy, dtheta] : steps) {
    stamp_ns += 1'000'001 + std::abs(static_cast<std::int64_t>(dx));
    RC_ASSERT(trajectory.append({{stamp_ns}, Pose2(dx / 7.0, dy / 3e3, dtheta / 1e5), {}}));
  }
  const auto read = parse_tum(tum_text(trajectory), "t.tum");
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->size() == trajectory.size());
  for (std::size_t i = 0; i < read->size(); ++i) {
    const Pose2& in = trajectory[i].T_map_base;
    const Pose2& out = (*read)[i].T_map_base;
    RC_ASSERT((*read)[i].stamp == trajectory[i].stamp);
    RC_ASSERT(in.x_m() == out.x_m());
    RC_ASSERT(in.y_m() == out.y_m());
    RC_ASSERT(std::abs(wrap_angle(in.theta_rad() - out.theta_rad())) <= kAngleRoundTrip_rad);
  }
}

TEST(Tum, AFileHoldsTheText) {
  Trajectory trajectory;
  ASSERT_TRUE(trajectory.append({{100'000'000}, Pose2(1.5, -2, 0), {}}));
  const ScratchFolder folder;
  ASSERT_TRUE(write_tum(trajectory, folder / "t.tum"));
  EXPECT_EQ(read_text(folder / "t.tum"), "0.100000000 1.5 -2 0 0 0 0 1\n");
  EXPECT_EQ((*read_tum(folder / "t.tum"))[0].T_map_base, Pose2(1.5, -2, 0));
}

TEST(Tum, ReadsWhatEvoWrites) {
  const ScratchFolder folder;
  write_text(folder / "t.tum",
             "# timestamp tx ty tz qx qy qz qw\n"
             "1.000000000 2.5 -1 0 0 0 0.70710678 0.70710678\n"
             "\n"
             "1.1e0 0 0 0 0 0 0 1\n");
  const auto read = read_tum(folder / "t.tum");
  ASSERT_FALSE(read.has_value());  // exponents would lose digits of a stamp
  EXPECT_NE(read.error().to_line().find("t.tum:4: stamp '1.1e0'"), std::string::npos);
  write_text(folder / "t.tum", "1.000000000 2.5 -1 0 0 0 0.70710678 0.70710678\n");
  EXPECT_NEAR((*read_tum(folder / "t.tum"))[0].T_map_base.theta_rad(), std::acos(-1) / 2, 1e-8);
}

TEST(Tum, AnswersEachDefectWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"1 0 0 0 0 0 1", "7 fields"},
      {"1 0 0 0 0 0 0 1 9", "9 fields"},
      {"1 nan 0 0 0 0 0 1", "'nan'"},
      {"1 0 inf 0 0 0 0 1", "'inf'"},
      {"1 0 0 0 0 0 0 0", "quaternion of length 0"},
      {"1 0 0 0 0 0 0 1.1", "quaternion of length 1.1"},
      {"1 0 0 0 0.1 0 0 0.99498744", "roll or pitch"},
      {"0.5 0 0 0 0 0 0 1", "not later"},
      {"0.25 0 0 0 0 0 0 1", "not later"},
      {"x 0 0 0 0 0 0 1", "stamp 'x'"},
  };
  const ScratchFolder folder;
  for (const auto& [line, message] : defects) {
    write_text(folder / "t.tum", "0.5 0 0 0 0 0 0 1\n" + line + "\n");
    const auto read = read_tum(folder / "t.tum");
    ASSERT_FALSE(read.has_value()) << line;
    EXPECT_NE(read.error().to_line().find("t.tum:2: "), std::string::npos);
    EXPECT_NE(read.error().to_line().find(message), std::string::npos) << read.error().to_line();
  }
}

TEST(Tum, NoPoseIsAnEmptyTrajectory) {
  const ScratchFolder folder;
  write_text(folder / "t.tum", "# nothing\n");
  EXPECT_TRUE(read_tum(folder / "t.tum")->empty());
}

TEST(Relations, ReadUndoesWriteEvenBackwardsInTime) {
  const std::vector<Relation> relations = {
      {{1'000'000'000}, {2'500'000'000}, Pose2(0.40795, -0.01633, -0.06962)},
      {{3'000'000'000}, {2'000'000'001}, Pose2(-0.1, 1.0 / 3, 3.0)},
  };
  const ScratchFolder folder;
  ASSERT_TRUE(write_relations(relations, folder / "a.relations"));
  EXPECT_EQ(*read_relations(folder / "a.relations"), relations);
}

TEST(Relations, AnswersEachDefectWithItsLine) {
  const std::vector<std::string> defects = {"1 2 0 0 0 0 0",     "1 2 0 0 0 0 0 0 0",
                                            "1 x 0 0 0 0 0 0",   "1 2 nan 0 0 0 0 0",
                                            "1 2 0 0 0.5 0 0 0", "1 2 0 0 0 0.1 0 0"};
  const ScratchFolder folder;
  for (const std::string& line : defects) {
    write_text(folder / "a.relations", "# comment\n" + line + "\n");
    const auto read = read_relations(folder / "a.relations");
    ASSERT_FALSE(read.has_value()) << line;
    EXPECT_NE(read.error().to_line().find("a.relations:2: "), std::string::npos);
  }
}

TEST(Relations, RefusesWhatNoRobotDoes) {
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"5 5 0.1 0 0 0 0 0", "t1 and t2 are the same time; expected two times"},
      {"5 6 0.1 0 0 0 0 1e300", "a turn of 1e+300 rad; expected at most 2 pi"},
      {"5 6 0.1 0 0 0 0 -90", "a turn of -90 rad; expected at most 2 pi (degrees"},
      {"5 6 48.5 0 0 0 0 0", "a motion of 48.5 m in 1 s; expected at most 10 m/s (centimetres"},
      {"5 6 1e300 0 0 0 0 0", "a motion of"},
      {"1 2 0.2 0 0 0 0 0", "another relation between these two times"},
      {"5000000000 6 0.1 0 0 0 0 0", "stamp '5000000000'"},
      {"5 6 0,1 0 0 0 0 0", "field '0,1'"},
  };
  const ScratchFolder folder;
  for (const auto& [line, message] : defects) {
    write_text(folder / "a.relations", "1 2 0.1 0 0 0 0 0\n" + line + "\n");
    const auto read = read_relations(folder / "a.relations");
    ASSERT_FALSE(read.has_value()) << line;
    EXPECT_NE(read.error().to_line().find("a.relations:2: "), std::string::npos);
    EXPECT_NE(read.error().to_line().find(message), std::string::npos) << read.error().to_line();
  }
}

TEST(Relations, KeepsThoseInAnyOrderAndThoseGivenTwice) {
  const ScratchFolder folder;
  write_text(folder / "a.relations",
             "7 8 0.5 0 0 0 0 0.25\n1 2 0.1 0 0 0 0 0\n7 8 0.5 0 0 0 0 0.25\n2 1 -0.1 0 0 0 0 0\n");
  const auto read = read_relations(folder / "a.relations");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->size(), 4U);
  EXPECT_EQ(num_repeated(*read), 1U);
}

TEST(Relations, RefusesALastNumberThatMayBeCut) {
  const ScratchFolder folder;
  write_text(folder / "a.relations", "1 2 0.1 0 0 0 0 0\n3 4 0.1 0 0 0 0 0.12");
  const auto read = read_relations(folder / "a.relations");
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().to_line().find("a.relations:2: the last line has no end"),
            std::string::npos)
      << read.error().to_line();
}

TEST(Relations, AFileWithoutAnyIsAnError) {
  const ScratchFolder folder;
  write_text(folder / "a.relations", "# none\n");
  EXPECT_FALSE(read_relations(folder / "a.relations").has_value());
}

}  // namespace
}  // namespace corridor::formats
