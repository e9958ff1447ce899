// What is wrong with a request or its input is said in exactly one line, with exit code 2, and
// nothing is left behind.
#include <gtest/gtest.h>

#include "tests/bench/cli/program.hpp"

namespace corridor::testing {
namespace {

constexpr const char* kGoodLog =
    "ODOM 0 0 0 0.2 0 0 1.0 host 1.0\n"
    "FLASER 4 1 1 1 1 0 0 0 0 0 0 1.0 host 1.0\n"
    "ODOM 0.1 0 0 0.2 0 0 1.1 host 1.1\n"
    "FLASER 4 1 1 1 1 0.1 0 0 0.1 0 0 1.1 host 1.1\n";

TEST(BadRequest, AnEmptyLog) {
  const ScratchFolder folder;
  folder.write("empty.clf", "");
  folder.write("empty.rawlog", "");
  expect_refused(folder, "run --system karto --dataset empty.clf --out o", {"empty.clf", "empty"});
  expect_refused(folder, "run --system karto --dataset empty.rawlog --out o",
                 {"empty.rawlog", "empty"});
}

TEST(BadRequest, ATruncatedLog) {
  const ScratchFolder folder;
  std::string text = kGoodLog;
  folder.write("cut.clf", text.substr(0, text.size() - 25));
  expect_refused(folder, "run --system karto --dataset cut.clf --out o", {"cut.clf", "4"});
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out whole.rawlog").exit_code, 0);
  text = text_of(folder / "whole.rawlog");
  folder.write("cut.rawlog", text.substr(0, text.size() / 2));
  expect_refused(folder, "run --system karto --dataset cut.rawlog --out o",
                 {"cut.rawlog", "truncated"});
}

TEST(BadRequest, StampsOutOfOrder) {
  const ScratchFolder folder;
  folder.write("order.clf",
               std::string(kGoodLog) + "FLASER 4 1 1 1 1 0.1 0 0 0.1 0 0 0.5 host 0.5\n");
  expect_refused(folder, "run --system karto --dataset order.clf --out o", {"order.clf", "5"});
}

TEST(BadRequest, AnUnknownSystem) {
  const ScratchFolder folder;
  expect_refused(folder, "run smoke --system nobody --out o",
                 {"--system: unknown system \"nobody\"; expected one of: ", "karto"});
}

TEST(BadRequest, AnUnknownKeyInASuite) {
  const ScratchFolder folder;
  folder.write(
      "mine.toml",
      "name = \"mine\"\nsystems = [\"karto\"]\nscenarios = [\"paper-corridor\"]\nsede = 1\n");
  expect_refused(folder, "run mine.toml --out o", {"mine.toml:4", "unknown key \"sede\""});
}

TEST(BadRequest, UnknownNames) {
  const ScratchFolder folder;
  expect_refused(folder, "run nosuite --out o", {"nosuite", "smoke"});
  expect_refused(folder, "run smoke --backend magic --out o",
                 {"--backend: unknown back-end \"magic\"; expected one of: ", "levenberg"});
  expect_refused(folder, "run smoke --dataset paper-coridor --out o",
                 {"'paper-coridor' is neither a data set nor a scenario nor a file",
                  "the nearest names: paper-corridor, "});
  expect_refused(
      folder, "run smoke --set karto.nope=1 --out o",
      {"--set: system karto: unknown parameter nope (nearest: ", "list profiles --json"});
  expect_refused(folder, "run smoke --system karto --out o --set gmapping.particles=5",
                 {"--set: system \"gmapping\" is not run; expected one of: karto"});
  expect_refused(folder,
                 "run smoke --out o --set karto.buffer_size_scans=50 "
                 "--set karto.buffer_size_scans=60",
                 {"--set: karto.buffer_size_scans is given twice"});
  expect_refused(folder, "run smoke --system karto --backend isam2 --out o --set isam2.wildfir=1",
                 {"--set: back-end isam2: unknown parameter wildfir (nearest: wildfire"});
  expect_refused(folder, "run smoke --system karto --out o --set isam2.wildfire=1",
                 {"--set: back-end \"isam2\" is not run; expected one of: levenberg"});
  expect_refused(folder, "run smoke --executor slurm --out o", {"slurm", "local"});
  expect_refused(folder, "simulate nowhere --out x.rawlog", {"nowhere"});
  expect_refused(folder, "data verify nowhere", {"nowhere"});
  expect_refused(folder, "list nothing", {"nothing"});
}

TEST(BadRequest, CommandLinesThatCannotBeRead) {
  const ScratchFolder folder;
  expect_refused(folder, "", {"--help"});
  expect_refused(folder, "frobnicate", {"unknown command \"frobnicate\"", "simulate", "or data"});
  expect_refused(folder, "data mend x.clf",
                 {"unknown command \"data mend\"; expected list, verify, fetch or inspect"});
  expect_refused(folder, "data inspect x.clf", {"'x.clf' is neither a data set nor a log file"});
  expect_refused(folder, "run", {"SUITE"});
  expect_refused(folder, "run smoke --jobs none", {"--jobs"});
  expect_refused(folder, "run smoke --bogus", {"--bogus"});
}

TEST(BadRequest, FilesThatStateNothing) {
  const ScratchFolder folder;
  folder.write("empty.toml", "");
  folder.write("remarks.toml", "# nothing yet\n");
  folder.write("data/catalog.toml", "");
  folder.write("on-empty.toml", "base = \"empty.toml\"\n");
  folder.write("a.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  folder.write("m.pgm", "P5 1 1 255\nx");
  folder.write("m.yaml",
               "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
               "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
  const std::string nothing = "states nothing; expected at least one key";
  expect_refused(folder, "simulate empty.toml --out x.rawlog", {"empty.toml: " + nothing});
  expect_refused(folder, "simulate remarks.toml --out x.rawlog", {"remarks.toml: " + nothing});
  expect_refused(folder, "simulate on-empty.toml --out x.rawlog", {"empty.toml: " + nothing});
  expect_refused(folder, "run --system karto --dataset empty.toml --out o", {nothing});
  expect_refused(folder, "run empty.toml --out o", {"empty.toml:1: key \"name\" is missing"});
  expect_refused(folder, "data list --data-dir data", {"catalog.toml: dataset: missing"});
  expect_refused(folder, "evaluate --estimate a.tum --truth a.tum --map m.yaml --world empty.toml",
                 {"empty.toml: " + nothing});
  folder.write("a.clf", "FLASER 2 1 2 0 0 0 0 0 0 1 h 1\n");
  folder.write("a.robot.toml", "[lidar]\n");
  expect_refused(folder, "data inspect a.clf", {"a.robot.toml: " + nothing});
}

TEST(BadRequest, SeedsThatAreNoSeeds) {
  const ScratchFolder folder;
  const std::string range = "expected a whole number from 0 to 18446744073709551615";
  for (const std::string seed : {"-1", "99999999999999999999999", "18446744073709551616", "1x"}) {
    const std::string line = "--seed: " + seed + "; " + range;
    expect_refused(folder, "run smoke --out o --seed " + seed, {line});
    expect_refused(folder, "simulate paper-corridor --out x.rawlog --seed " + seed, {line});
  }
  expect_refused(folder, "run smoke --out o --seeds 2 --seed 18446744073709551615",
                 {"--seed: 2 seeds from 18446744073709551615"});
}

TEST(BadRequest, FilesThatCannotBeReadOrWritten) {
  const ScratchFolder folder;
  expect_refused(folder, "run-case no.json --out o", {"no.json"});
  folder.write("bad.json", "{}");
  expect_refused(folder, "run-case bad.json --out o", {"bad.json", "\"system\" is missing"});
  expect_refused(folder, "simulate paper-corridor --out no/such/x.rawlog", {"no/such"});
  expect_refused(folder, "simulate paper-corridor --out x.txt", {"x.txt", ".rawlog"});
  expect_refused(folder, "convert no.clf x.rawlog", {"no.clf"});
  expect_refused(folder, "report nowhere --out r", {"nowhere"});
  expect_refused(folder, "report nowhere --out r/s/", {"nowhere"});
}

TEST(BadRequest, AConversionOntoItselfOrBesideAnotherLogsWorld) {
  const ScratchFolder folder;
  folder.write("a.clf", kGoodLog);
  folder.write("b.truth.toml", "another world");
  folder.write("c.tum", "1 0 0 0 0 0 0 1\n");
  std::filesystem::create_symlink("a.clf", folder / "link.clf");
  expect_refused(folder, "convert a.clf a.clf", {"a.clf", "the file that is read"});
  expect_refused(folder, "convert a.clf ./link.clf", {"link.clf", "the file that is read"});
  expect_refused(folder, "convert a.clf b.rawlog", {"b.truth.toml", "would pass for"});
  expect_refused(folder, "convert a.clf c.rawlog", {"c.tum", "would pass for"});
  EXPECT_EQ(text_of(folder / "a.clf"), kGoodLog);
}

TEST(BadRequest, AnOutputThatCannotBeWritten) {
  const ScratchFolder folder;
  for (const std::string arguments : {"list systems", "--help", "data list --json"}) {
    const Answer answer = run_program(folder, arguments + " >/dev/full 2>err.txt; echo $?");
    EXPECT_EQ(answer.out, "2\n") << arguments;
    const std::string said = text_of(folder / "err.txt");
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_NE(said.find("stdout"), std::string::npos) << said;
  }
}

TEST(BadRequest, AnEvaluationWithNothingToCompare) {
  const ScratchFolder folder;
  folder.write("e.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  folder.write("far.tum", "1000 0 0 0 0 0 0 1\n2000 1 0 0 0 0 0 1\n");
  folder.write("bad.tum", "1 0 0 0 0 0 0 1\n2 1 0 zero 0 0 0 1\n");
  expect_refused(folder, "evaluate --estimate e.tum", {"--truth"});
  expect_refused(folder, "evaluate --estimate e.tum --truth no.tum",
                 {"no.tum: no such file; expected a trajectory, TUM"});
  expect_refused(folder, "evaluate --estimate e.tum --truth bad.tum", {"bad.tum:2"});
  expect_refused(folder, "evaluate --estimate e.tum --truth far.tum", {"no pose could be matched"});
  folder.write("far.relations", "1000 2000 1 0 0 0 0 0\n");
  expect_refused(folder, "evaluate --estimate e.tum --relations far.relations",
                 {"no relation could be matched", "far.relations"});
  expect_refused(folder, "evaluate --estimate e.tum --truth e.tum --map m.yaml", {"--world"});
  expect_refused(folder, "evaluate --estimate e.tum --truth e.tum --map m.pgm --world w.toml",
                 {"--map m.pgm", "expected the .yaml"});
  for (const std::string span : {"nan", "-1", "1e-2s"}) {
    expect_refused(folder, "evaluate --estimate e.tum --truth e.tum --max-dt '" + span + "'",
                   {"--max-dt", "\"" + span + "\"", "expected seconds, 0 or more"});
  }
}

TEST(BadRequest, ADataFolderThatIsNotThere) {
  const ScratchFolder folder;
  folder.write("file", "");
  for (const std::string arguments :
       {"run smoke --out o --data-dir nonexist", "data list --data-dir nonexist",
        "convert a.clf b.rawlog --data-dir nonexist"}) {
    expect_refused(folder, arguments,
                   {"--data-dir", "\"nonexist\" is no folder", "expected an existing folder"});
  }
  expect_refused(folder, "data list --data-dir file", {"\"file\" is no folder"});
}

TEST(BadRequest, AFolderAsALog) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "logs");
  expect_refused(folder, "run --system karto --dataset logs --out o",
                 {"logs: this is a folder; expected a log file"});
  expect_refused(folder, "convert logs x.rawlog", {"logs: this is a folder; expected a log file"});
  expect_refused(folder, "simulate ./logs --out x.rawlog",
                 {"./logs: this is a folder; expected a"});
}

TEST(BadRequest, ADeviceAsALog) {
  const ScratchFolder folder;
  expect_refused(folder, "run --system karto --dataset /dev/null --out o",
                 {"/dev/null: this is no regular file; expected a log file"});
  for (const char* command : {"convert /dev/null x.rawlog", "data inspect /dev/null",
                              "simulate /dev/null --out x.rawlog"}) {
    expect_refused(folder, command, {"/dev/null: this is no regular file; expected a"});
  }
}

TEST(BadRequest, ATruthOfAnotherClock) {
  const ScratchFolder folder;
  folder.write("run.clf", kGoodLog);
  folder.write("run.tum", "1000 0 0 0 0 0 0 1\n2000 1 0 0 0 0 0 1\n");
  expect_refused(
      folder, "run --system karto --dataset run.clf --out o",
      {"run.tum", "no stamp in common", "1000.000 s to 2000.000 s", "1.000 s to 1.100 s"});
}

// As an interrupted copy leaves it.
TEST(BadRequest, ALogWhoseTruthIsEmpty) {
  for (const std::string text : {"", "# stamp x y z qx qy qz qw\n"}) {
    const ScratchFolder folder;
    folder.write("a.clf", kGoodLog);
    folder.write("a.tum", text);
    for (const std::string command :
         {"run --system dead-reckoning --dataset a.clf --out o", "convert a.clf b.bag"}) {
      expect_refused(folder, command, {"a.tum: the truth has no pose; expected tum poses"});
    }
    EXPECT_EQ(run_program(folder, "data inspect a.clf").exit_code, 1);
  }
}

// Whichever file beside the log is broken, before anything is run or written.
TEST(BadRequest, ALogWhoseTruthCannotBeRead) {
  for (const std::string name : {"a.tum", "a.relations", "a.truth.toml"}) {
    const ScratchFolder folder;
    folder.write("a.clf", kGoodLog);
    folder.write(name, "garbage\n");
    for (const std::string command :
         {"run --system dead-reckoning --dataset a.clf --out o --quiet", "convert a.clf b.bag"}) {
      expect_refused(folder, command, {name + ":1: "});
    }
  }
}

TEST(BadRequest, SomethingThatIsNoFileBesideALog) {
  for (const std::string suffix : {"robot.toml", "tum", "relations", "truth.toml"}) {
    const ScratchFolder folder;
    folder.write("a.clf", kGoodLog);
    folder.write("b.clf", kGoodLog);
    std::filesystem::create_directory(folder / ("a." + suffix));
    std::filesystem::create_symlink("nowhere", folder / ("b." + suffix));
    for (const std::string log : {"a", "b"}) {
      for (const char* command : {"run --system karto --out o --dataset ", "convert --quiet "}) {
        const bool is_convert = std::string(command).starts_with("convert");
        expect_refused(folder, command + log + ".clf" + (is_convert ? " c.bag" : ""),
                       {log + "." + suffix + ": this is no regular file; expected a file"});
      }
      EXPECT_GE(run_program(folder, "data inspect " + log + ".clf").exit_code, 1);
    }
  }
}

TEST(BadRequest, IsToldWithoutControlCharacters) {
  const ScratchFolder folder;
  for (const std::string command : {"run", "data verify", "", "run --system karto --dataset"}) {
    const Answer answer = run_program(folder, command + " \"$(printf 'a\\033[31mb\\rc')\"");
    EXPECT_EQ(answer.exit_code, 2) << command;
    EXPECT_NE(answer.err.find("a\\x1b[31mb\\x0dc"), std::string::npos) << answer.err;
    EXPECT_EQ(answer.err.find_first_of("\x1b\r"), std::string::npos) << command;
  }
}

TEST(BadRequest, AResultThatCannotBeWrittenIsAFailureOfTheCase) {
  const ScratchFolder folder;
  folder.write("one.toml",
               "name = \"one\"\nsystems = [\"fusion-paper\"]\nscenarios = [\"paper-corridor\"]\n");
  ASSERT_EQ(run_program(folder, "run one.toml --out o --no-report").exit_code, 0);
  const std::string id = contents_of(folder / "o" / "runs").front();
  std::filesystem::copy_file(folder / "o" / "runs" / id / "spec.json", folder / "spec.json");
  std::filesystem::remove_all(folder / "o");
  // A limit on the size of files stands for a full disk: 100 KiB hold the store, not the poses.
  const std::string limits = "ulimit -f 100; trap '' XFSZ; ";
  const Answer alone = run_program(folder, "run-case spec.json --out o", limits);
  EXPECT_EQ(alone.exit_code, 4);
  EXPECT_EQ(alone.num_error_lines(), 1) << alone.err;
  EXPECT_NE(alone.err.find("File too large"), std::string::npos) << alone.err;
  EXPECT_EQ(contents_of(folder / "o"), std::vector<std::string>{"runs"});
  const Answer run = run_program(folder, "run one.toml --out o --no-report", limits);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.out.find(": failed, "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("File too large"), std::string::npos) << run.out;
  EXPECT_EQ(run_program(folder, "run one.toml --out p --no-report", "ulimit -f 1; trap '' XFSZ; ")
                .exit_code,
            2)
      << "no store, no answer";
}

}  // namespace
}  // namespace corridor::testing
