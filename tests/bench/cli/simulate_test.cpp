// The command `simulate`: what it writes beside what, what it says of it, what it refuses.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "tests/bench/cli/program.hpp"
#include "tests/support/documents.hpp"

namespace corridor::testing {
namespace {

namespace fs = std::filesystem;

TEST(Simulate, GivesTheSameBytesForTheSameSeedAndTheTruthBesideThem) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --seed 4 --out a.rawlog").exit_code, 0);
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --seed 4 --out b.rawlog").exit_code, 0);
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --seed 5 --out c.rawlog").exit_code, 0);
  EXPECT_EQ(
      contents_of(folder.path()),
      (std::vector<std::string>{"a.rawlog", "a.truth.toml", "a.tum", "b.rawlog", "b.truth.toml",
                                "b.tum", "c.rawlog", "c.truth.toml", "c.tum"}));
  EXPECT_EQ(text_of(folder / "a.tum"), text_of(folder / "b.tum"));
  EXPECT_EQ(text_of(folder / "a.truth.toml"), text_of(folder / "b.truth.toml"));
  EXPECT_NE(text_of(folder / "a.tum"), text_of(folder / "c.tum"));
}

TEST(Simulate, LeavesTheFilesThatWereThereIfItCannotWrite) {
  const ScratchFolder folder;
  folder.write("log.rawlog", "my log");
  folder.write("log.truth.toml", "my world");
  std::filesystem::create_directory(folder / "log.tum");
  expect_refused(folder, "simulate paper-corridor --out log.rawlog",
                 {"log.tum", "no regular file"});
  EXPECT_EQ(text_of(folder / "log.rawlog"), "my log");
  EXPECT_EQ(text_of(folder / "log.truth.toml"), "my world");
}

// What `simulate` or `convert` said of the new file.
std::string counts_in(const std::string& said) {
  std::smatch found;
  const std::regex counts(R"(\d+ scans, \d+ wheel samples(, \d+ inertial samples)?)");
  return std::regex_search(said, found, counts) ? found.str() : "no counts in " + said;
}

// The lines of what was said that state a loss.
std::vector<std::string> losses_in(const std::string& said) {
  std::vector<std::string> losses;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("lost: ")) losses.push_back(line);
  }
  return losses;
}

// What a program leaves that is ended from outside goes with the next one that writes there.
TEST(Simulate, RemovesWhatEndedProgramsLeftAndNothingElse) {
  const ScratchFolder folder;
  constexpr int kNoProcess = 99'999'999;  // beyond the largest number that Linux gives
  const auto hidden = [](int process) { return fmt::format(".old.rawlog.{}.partial", process); };
  folder.write(fs::path(hidden(kNoProcess)) / "old.rawlog", "cut");
  fs::create_directory(folder / hidden(kNoProcess) / "previous");
  folder.write(fs::path(hidden(getpid())) / "old.rawlog", "being written");
  folder.write(fs::path(hidden(kNoProcess + 1)) / "previous" / "old.rawlog", "the only copy");
  folder.write(".mine.partial/file", "another's");
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / hidden(kNoProcess)));
  EXPECT_TRUE(fs::exists(folder / hidden(getpid())));
  EXPECT_TRUE(fs::exists(folder / hidden(kNoProcess + 1)));
  EXPECT_TRUE(fs::exists(folder / ".mine.partial"));
  EXPECT_TRUE(fs::exists(folder / "a.rawlog"));
}

TEST(Simulate, CountsWhatTheFileHolds) {
  const ScratchFolder folder;
  folder.write("late.toml", "base = \"stand-still\"\n[lidar]\ntime_offset_s = 0.2\n");
  for (const std::string suffix : {".rawlog", ".clf", ".bag"}) {
    const Answer answer = run_program(folder, "simulate late.toml --out a" + suffix);
    ASSERT_EQ(answer.exit_code, 0) << answer.err;
    const Answer copied = run_program(folder, "convert a" + suffix + " b" + suffix);
    ASSERT_EQ(copied.exit_code, 0) << copied.err;
    EXPECT_EQ(counts_in(answer.out), counts_in(copied.out)) << suffix;
    const bool has_imu = answer.out.find("inertial samples") != std::string::npos;
    EXPECT_EQ(has_imu, suffix != ".clf") << answer.out;
  }
}

TEST(Simulate, SaysTheLossesThatConvertSays) {
  const ScratchFolder folder;
  folder.write("late.toml",
               "base = \"stand-still\"\n[lidar]\ntime_offset_s = 0.2\nx_m = 0.3\n"
               "[imu]\nx_m = 0.1\n");
  ASSERT_EQ(run_program(folder, "simulate late.toml --out a.rawlog --quiet").exit_code, 0);
  for (const std::string suffix : {".bag", ".clf"}) {
    const Answer answer = run_program(folder, "simulate late.toml --out a" + suffix);
    ASSERT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.out.find("lost: the LiDAR's stamps stay 0.2 s ahead"), std::string::npos)
        << answer.out;
    EXPECT_NE(answer.out.find("lost: the robot model is left out"), std::string::npos)
        << answer.out;
    // From the rawlog, whose rounding of angles is said when it is written.
    const auto losses = losses_in(answer.out);
    for (const std::string& loss :
         losses_in(run_program(folder, "convert a.rawlog b" + suffix).out)) {
      EXPECT_NE(std::find(losses.begin(), losses.end(), loss), losses.end()) << loss;
    }
  }
}

TEST(Simulate, RefusesANameBesideWhichAnotherLogsFilesLie) {
  for (const std::string suffix :
       {".robot.toml", ".relations", ".reference.tum", ".tum", ".truth.toml"}) {
    const ScratchFolder folder;
    folder.write("p" + suffix, "a stranger's\n");
    expect_refused(folder, "simulate stand-still --out p.rawlog", {"p" + suffix + ": this file"});
    EXPECT_EQ(text_of(folder / ("p" + suffix)), "a stranger's\n");
  }
}

TEST(Simulate, RefusesAStrangersTopicsBesideABagOnly) {
  const ScratchFolder folder;
  folder.write("p.topics.toml", "[topics]\n");
  expect_refused(folder, "simulate stand-still --out p.bag", {"p.topics.toml", "the new bag"});
  EXPECT_EQ(run_program(folder, "simulate stand-still --out p.rawlog").exit_code, 0);
}

TEST(Simulate, ReplacesALogWithItsTruthButNotTheTruthThatAnotherLogShares) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out p.rawlog").exit_code, 0);
  const std::string first = text_of(folder / "p.tum");
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --seed 2 --out p.rawlog").exit_code, 0);
  const std::string second = text_of(folder / "p.tum");
  EXPECT_NE(second, first);
  EXPECT_EQ(run_program(folder, "simulate paper-corridor --seed 2 --out p.clf").exit_code, 0)
      << "the same truth for both";
  expect_refused(folder, "simulate paper-corridor --seed 3 --out p.clf",
                 {"p.tum: this file of p.rawlog would be overwritten"});
  EXPECT_EQ(text_of(folder / "p.tum"), second);
}

TEST(Simulate, NamesEverySuffixThatIsWrittenInItsHelpAndItsRefusal) {
  const ScratchFolder folder;
  const std::string suffixes = ".clf .clf.gz .log .log.gz .rawlog .rawlog.gz .bag";
  for (const std::string command : {"simulate", "convert"}) {
    const Answer help = run_program(folder, command + " --help");
    EXPECT_NE(help.out.find(suffixes), std::string::npos) << help.out;
  }
  expect_refused(folder, "simulate stand-still --out p.txt", {"p.txt", suffixes});
  expect_refused(folder, "simulate stand-still --out p.lcm", {"p.lcm", suffixes});
  for (const std::string suffix : {".log.gz", ".rawlog.gz"}) {
    const Answer answer = run_program(folder, "simulate stand-still --out p" + suffix);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
  }
}

TEST(Simulate, TakesTheExampleOfTheScenariosReadmeAsThatSays) {
  const std::string readme = text_of_document("datasets/scenarios/README.md");
  const auto examples = examples_in(readme, "toml");
  ASSERT_EQ(examples.size(), 1U);
  const ScratchFolder folder;
  folder.write("my-corridor.toml", examples.front());
  EXPECT_NE(readme.find("`simulate` takes one of its members, `my-corridor.toml@3.5`"),
            std::string::npos);
  expect_refused(folder, "simulate my-corridor.toml --out p.rawlog",
                 {"a family of scenarios needs one of its members", "3.5 4.5 6"});
  const Answer member = run_program(folder, "simulate my-corridor.toml@3.5 --out p.rawlog");
  EXPECT_EQ(member.exit_code, 0) << member.err;
  const Answer run = run_program(
      folder, "run --system dead-reckoning --dataset my-corridor.toml --out o --no-report");
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace corridor::testing
