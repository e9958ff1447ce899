// The command `convert`: which kind of file becomes which, what is said about it, what is refused.
#include <gtest/gtest.h>

#include "tests/bench/cli/program.hpp"

namespace corridor::testing {
namespace {

constexpr const char* kTum = "1.000000001 1 2 0 0 0 0 1\n2.5 3 4 0 0 0 1 0\n";
constexpr const char* kG2o =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nFIX 0\nEDGE_SE2 0 1 1 0 0 1 0.1 0.2 2 0.3 3\n";

TEST(Convert, TakesATrajectoryThroughEveryFormatAndBack) {
  const ScratchFolder folder;
  folder.write("a.tum", kTum);
  for (const std::string step :
       {"a.tum b.kitti", "b.kitti c.csv", "c.csv d.clf.gz", "d.clf.gz e.tum"}) {
    const Answer answer = run_program(folder, "convert " + step);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.out.find("2 poses"), std::string::npos) << answer.out;
  }
  EXPECT_EQ(text_of(folder / "b.times"), "1.000000001\n2.500000000\n");
  const std::string text = text_of(folder / "e.tum");
  EXPECT_EQ(text.find("1.000000001 1 2 0 0 0 0 1\n2.500000000 3 4 0 0 0 1 "), 0U) << text;
}

TEST(Convert, SaysThatKittiHoldsNoStamps) {
  const ScratchFolder folder;
  folder.write("a.tum", kTum);
  const Answer answer = run_program(folder, "convert a.tum b.kitti");
  EXPECT_NE(answer.out.find("lost: 2 stamps"), std::string::npos) << answer.out;
}

TEST(Convert, TakesAGraphToToroAndBackWithoutChangingANumber) {
  const ScratchFolder folder;
  folder.write("a.g2o", kG2o);
  const Answer there = run_program(folder, "convert a.g2o b.graph");
  EXPECT_EQ(there.exit_code, 0) << there.err;
  EXPECT_NE(there.out.find("lost: 1 fixed poses"), std::string::npos) << there.out;
  EXPECT_EQ(text_of(folder / "b.graph"),
            "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0 1 0.1 2 3 0.2 0.3\n");
  const Answer back = run_program(folder, "convert b.graph c.g2o");
  EXPECT_NE(back.out.find("2 poses, 1 edge, nothing lost"), std::string::npos) << back.out;
  EXPECT_EQ(text_of(folder / "c.g2o"),
            "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0.1 0.2 2 0.3 3\n");
}

TEST(Convert, TakesALogToARosBagAndBack) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  const Answer there = run_program(folder, "convert a.rawlog b.bag");
  ASSERT_EQ(there.exit_code, 0) << there.err;
  EXPECT_NE(there.out.find("lost: the robot model"), std::string::npos) << there.out;
  EXPECT_TRUE(std::filesystem::exists(folder / "b.tum")) << "the truth goes along";
  const Answer back = run_program(folder, "convert b.bag c.rawlog");
  ASSERT_EQ(back.exit_code, 0) << back.err;
  // Both end with "NAME: N scans, N wheel samples, N inertial samples".
  const auto counts = [](const std::string& said) {
    const std::size_t begin = said.rfind(": ") + 2;
    return said.substr(begin, said.find(" inertial") - begin);
  };
  EXPECT_EQ(counts(back.out), counts(there.out));
}

// A laser line of 4 beams, one of them without return, taken `stamp` s after the begin.
std::string laser_line(const std::string& stamp) {
  return "ROBOTLASER1 0 -0.75 1.5 0.5 4.5 0.01 0 4 1.5 2 0 2.5 0 0 0 0 0 0 0 0 0 0 0 0 " + stamp +
         " h " + stamp + "\n";
}

std::string wheel_line(const std::string& stamp) {
  return "ODOM 0 0 0 0 0 0 " + stamp + " h " + stamp + "\n";
}

TEST(Convert, SaysWhatTheReaderDidToTheReadings) {
  const ScratchFolder folder;
  folder.write("a.clf", "PARAM x 1\n" + wheel_line("0.05") + laser_line("0.1"));
  const Answer answer = run_program(folder, "convert a.clf b.rawlog");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  for (const char* part : {"note: 1 PARAM lines skipped", "note: 1 beams of range 0 taken as no"}) {
    EXPECT_NE(answer.out.find(part), std::string::npos) << part << " in " << answer.out;
  }
}

TEST(Convert, DoesNotCallNothingLostWhatTheReaderLeftOut) {
  const ScratchFolder folder;
  folder.write("a.clf", wheel_line("0.05") + laser_line("0.1"));
  const Answer answer = run_program(folder, "convert a.clf b.rawlog");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  for (const char* part : {"note: 2 lines lose their host and the logger's stamp",
                           "b.rawlog: 1 scans, 2 wheel samples, nothing lost but what the notes"}) {
    EXPECT_NE(answer.out.find(part), std::string::npos) << part << " in " << answer.out;
  }
}

TEST(Convert, SaysWhatLooksWrongWithTheReadings) {
  const ScratchFolder folder;
  std::string text;
  for (int second = 0; second < 4; ++second) text += laser_line(std::to_string(10 * second));
  folder.write("a.clf", text);
  const Answer answer = run_program(folder, "convert a.clf b.rawlog");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_NE(answer.out.find("suspicious: LiDAR: 10.000 s between readings; milliseconds"),
            std::string::npos)
      << answer.out;
}

TEST(Convert, RefusesWhatTheReaderOfTheCopyWouldRefuse) {
  const ScratchFolder folder;
  folder.write("a.clf", wheel_line("0.04") + wheel_line("0.04000001") + laser_line("0.1"));
  expect_refused(folder, "convert a.clf b.rawlog",
                 {"b.rawlog: byte ", "the format cannot hold this log", "stamp repeats"});
}

TEST(Convert, RefusesDegreesForRadians) {
  const ScratchFolder folder;
  std::string degrees = laser_line("0.1");
  degrees.replace(degrees.find("-0.75 1.5 0.5"), 13, "-45 90 30");
  folder.write("a.clf", degrees);
  expect_refused(folder, "convert a.clf b.rawlog", {"a.clf:1: field of view", "degrees"});
}

TEST(Convert, InventsNoOdometry) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  ASSERT_EQ(run_program(folder, "convert a.rawlog b.bag --quiet").exit_code, 0);
  folder.write("b.topics.toml", "[topics]\nodometry = \"\"\n");
  expect_refused(folder, "convert b.bag c.clf", {"c.clf: the log has no wheel sample; expected"});
}

TEST(Convert, SaysOnlyWhatIsLostOfThisVeryLog) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  const Answer same = run_program(folder, "convert a.rawlog b.rawlog");
  EXPECT_NE(same.out.find("nothing lost\n"), std::string::npos) << same.out;
  EXPECT_TRUE(text_of(folder / "a.rawlog") == text_of(folder / "b.rawlog"));
  const Answer text = run_program(folder, "convert a.rawlog c.clf");
  EXPECT_NE(text.out.find("lost: the robot model"), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("inertial samples"), std::string::npos) << text.out;
  const Answer again = run_program(folder, "convert c.clf d.clf");
  EXPECT_NE(again.out.find("nothing lost\n"), std::string::npos) << again.out;
  EXPECT_TRUE(text_of(folder / "c.clf") == text_of(folder / "d.clf"));
}

TEST(Convert, NamesTheLidarsClockWhereTheNewLogCannot) {
  const ScratchFolder folder;
  folder.write("late.toml", "base = \"stand-still\"\n[lidar]\ntime_offset_s = 0.1\n");
  ASSERT_EQ(run_program(folder, "simulate late.toml --out a.rawlog --quiet").exit_code, 0);
  for (const std::string to : {"b.bag", "b.clf"}) {
    const Answer answer = run_program(folder, "convert a.rawlog " + to);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.out.find("lost: the LiDAR's stamps stay 0.1 s ahead"), std::string::npos)
        << answer.out;
  }
}

TEST(Convert, RefusesABrokenBagAndAStrangersTopicsOrCalibration) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  ASSERT_EQ(run_program(folder, "convert a.rawlog b.bag --quiet").exit_code, 0);
  const std::string bag = text_of(folder / "b.bag");
  folder.write("cut.bag", bag.substr(0, bag.size() / 2));
  folder.write("d.topics.toml", "[topics]\n");
  expect_refused(folder, "convert cut.bag c.rawlog", {"cut.bag: byte 13: ", "index at byte"});
  expect_refused(folder, "convert a.rawlog d.bag", {"d.topics.toml", "topics of the new bag"});
  folder.write("e.robot.toml", "[lidar]\nx_m = 1.0\n");
  expect_refused(folder, "convert a.rawlog e.bag", {"e.robot.toml", "would calibrate the new log"});
}

TEST(Convert, KeepsTheTruthOfAnotherLogOfTheSameName) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  ASSERT_EQ(run_program(folder, "convert a.rawlog b.bag --quiet").exit_code, 0);
  EXPECT_EQ(run_program(folder, "convert a.rawlog b.clf").exit_code, 0) << "the same truth";
  folder.write("b.tum", kTum);
  expect_refused(folder, "convert a.rawlog b.clf",
                 {"b.tum: this file of b.bag would be overwritten"});
  expect_refused(folder, "convert a.rawlog b.rawlog", {"b.tum: this file of b."});
  EXPECT_EQ(text_of(folder / "b.tum"), kTum);
}

TEST(Convert, RefusesToMakeOneKindOfFileFromAnother) {
  const ScratchFolder folder;
  folder.write("a.tum", kTum);
  folder.write("a.g2o", kG2o);
  expect_refused(folder, "convert a.tum b.g2o", {"b.g2o", "trajectory", ".tum"});
  expect_refused(folder, "convert a.g2o b.tum", {"b.tum", "graph", ".g2o"});
  expect_refused(folder, "convert a.tum b.rawlog", {"b.rawlog", "trajectory"});
  expect_refused(folder, "convert a.g2o a.g2o", {"a.g2o", "the file that is read"});
  expect_refused(folder, "convert a.g2o no/b.graph", {"no", "folder"});
}

TEST(Convert, NamesTheLineOfADefect) {
  const ScratchFolder folder;
  folder.write("bad.g2o", std::string(kG2o) + "EDGE_SE2 0 7 1 0 0 1 0 0 1 0 1\n");
  folder.write("bad.csv", "1000,0,0,0,0,0,0,0\n");
  folder.write("alone.kitti", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expect_refused(folder, "convert bad.g2o b.graph", {"bad.g2o:5: ", "pose 7"});
  expect_refused(folder, "convert bad.csv b.tum", {"bad.csv:1: ", "quaternion"});
  expect_refused(folder, "convert alone.kitti b.tum", {"alone.kitti", "alone.times"});
}

}  // namespace
}  // namespace corridor::testing
