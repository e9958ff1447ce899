// What a report says about the limits of its own numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "reports/html/caveats.hpp"
#include "reports/html/reproduce.hpp"
#include "reports/tables/paper_world.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"
#include "reports/timing.hpp"
#include "tests/reports/synthetic_run.hpp"

namespace corridor::reports {
namespace {

using results::RunResult;
using testing::make_cases;
using Texts = std::map<std::string, std::string>;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<RunResult> synthetic_results(std::vector<testing::SyntheticSystem> systems,
                                         std::uint64_t num_worlds = 8) {
  return testing::synthetic_results(testing::run_of(std::move(systems)), num_worlds);
}

TEST(TimingNotes, SayWhereTheNumberOfCasesAtATimeIsUnknown) {
  const Cases cases = make_cases(synthetic_results({{"karto", 0.06}}, 2));
  EXPECT_THAT(timing_notes(cases), ElementsAre(HasSubstr("not recorded for 2 of 2 cases")));
}

TEST(TimingNotes, WarnOfCasesThatRanBesideOthers) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 3);
  results[0].jobs = 1;
  results[1].jobs = 4;
  EXPECT_THAT(
      timing_notes(make_cases(results)),
      ElementsAre(StartsWith("Warning: 1 of 3 cases ran beside others, up to 4 at a time")));
}

TEST(TimingNotes, SayThatCasesRanOneAtATimeOnlyIfAllDid) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[0].jobs = 1;
  EXPECT_THAT(timing_notes(make_cases(results)), ElementsAre(HasSubstr("not recorded for 1 of 2")));
  results[1].jobs = 1;
  EXPECT_THAT(timing_notes(make_cases(results)), ElementsAre("Cases ran one at a time."));
}

TEST(TimingNotes, WarnOfMixedMachinesAndThreads) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[0].machine_id = "another machine";
  results[1].threads = 4;
  EXPECT_THAT(timing_notes(make_cases(results)),
              AllOf(Contains(StartsWith("Warning: cases of 2 machines")),
                    Contains(HasSubstr("different numbers of threads"))));
}

TEST(TimingNotes, StandInEveryTableOfTimes) {
  const Cases cases = make_cases(synthetic_results({{"karto", 0.06}}, 2));
  const std::string note = timing_notes(cases).front();
  EXPECT_THAT(tables::cost_table(cases).notes, Contains(note));
  EXPECT_THAT(tables::stage_table(cases).notes, Contains(note));
  EXPECT_THAT(html::caveats(cases), Contains(HasSubstr(note)));
}

TEST(ErrorTable, SaysWhereErrorsAreAgainstAReferenceAndNoTruth) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  for (RunResult& result : results) result.true_poses = "truth";
  EXPECT_THAT(tables::trajectory_error_table(make_cases(results)).notes,
              Not(Contains(HasSubstr("a reference"))));
  results[1].true_poses = "reference";
  EXPECT_THAT(tables::trajectory_error_table(make_cases(results)).notes,
              Contains(StartsWith("synthetic-corridor: compared with poses that the robot's own")));
}

TEST(PaperWorld, IsNoLogOfOnesOwn) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  EXPECT_TRUE(tables::is_paper_world(make_cases(results), "synthetic-corridor"));
  results[0].data_seed.reset();
  const Cases cases = make_cases(results);
  EXPECT_FALSE(tables::is_paper_world(cases, "synthetic-corridor"));
  EXPECT_THAT(tables::to_html(tables::trajectory_error_table(cases)), Not(HasSubstr("paper")));
  EXPECT_THAT(tables::to_html(tables::key_distance_table(cases)), Not(HasSubstr("paper")));
}

TEST(ComparisonTable, HoldsEachPairOnceAndSaysThatItIsNotCorrected) {
  const tables::Table table = tables::comparison_table(
      make_cases(synthetic_results({{"karto", 0.06}, {"fusion-paper", 0.02}, {"fusion", 0.01}})));
  EXPECT_EQ(table.rows.size(), 3U);
  EXPECT_THAT(table.notes, Contains(HasSubstr("not corrected for the number of pairs, 3.")));
}

TEST(KeyDistanceTables, SayThatMrptsMapsKeepNoHitCounts) {
  const std::vector<RunResult> with = synthetic_results({{"karto", 0.06}, {"mrpt-icp", 0.1}}, 2);
  const std::vector<RunResult> without = synthetic_results({{"karto", 0.06}}, 2);
  EXPECT_THAT(tables::key_distance_error_table(make_cases(with)).notes,
              Contains(HasSubstr("no hit counts")));
  EXPECT_THAT(tables::key_distance_error_table(make_cases(without)).notes,
              Not(Contains(HasSubstr("no hit counts"))));
}

TEST(KeyDistanceTable, MarksNothingThatASystemOutsideItBeats) {
  const auto results = synthetic_results({{"mrpt-icp", 0.005}, {"karto", 0.06}, {"fusion", 0.02}});
  EXPECT_THAT(tables::to_markdown(tables::key_distance_table(make_cases(results))),
              Not(HasSubstr("| **")));
}

TEST(Caveats, ClaimShippedParametersOnlyOfThoseThatHaveThem) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}, {"gmapping", 0.1}}, 2);
  for (RunResult& result : results) {
    if (result.system == "karto") result.profile = "as-shipped";
  }
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(AllOf(StartsWith("Profile as-shipped"), HasSubstr("get: karto."))));
}

TEST(Caveats, SayWhatATunedProfileIs) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}, {"gmapping", 0.1}}, 2);
  EXPECT_THAT(html::caveats(make_cases(results)), Not(Contains(StartsWith("Profile tuned"))));
  for (RunResult& result : results) {
    if (result.system == "karto") result.profile = "tuned";
  }
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(AllOf(StartsWith("Profile tuned"), HasSubstr("has one: karto ("))));
}

TEST(Caveats, SayThatADenseProfileWasChosenByHand) {
  std::vector<RunResult> results = synthetic_results({{"mrpt-icp", 0.06}, {"karto", 0.1}}, 2);
  EXPECT_THAT(html::caveats(make_cases(results)), Not(Contains(StartsWith("Profile dense"))));
  for (RunResult& result : results) {
    if (result.system == "mrpt-icp") result.profile = "dense";
  }
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(AllOf(StartsWith("Profile dense"), HasSubstr("get lost: mrpt-icp ("))));
}

TEST(Caveats, SayForWhichLogAProfileWasShipped) {
  std::vector<RunResult> results = synthetic_results({{"mrpt-rbpf", 0.06}, {"karto", 0.1}}, 2);
  EXPECT_THAT(html::caveats(make_cases(results)),
              Not(Contains(StartsWith("Profile as-shipped-icp"))));
  for (RunResult& result : results) {
    if (result.system == "mrpt-rbpf") result.profile = "as-shipped-icp";
  }
  EXPECT_THAT(
      html::caveats(make_cases(results)),
      Contains(AllOf(StartsWith("Profile as-shipped-icp"), HasSubstr(": mrpt-rbpf. On intel"))));
}

TEST(Caveats, SpeakOfTheSimulatorOnlyWhereOneWasUsed) {
  std::vector<RunResult> results = synthetic_results({{"fusion", 0.06}}, 2);
  EXPECT_THAT(html::caveats(make_cases(results)), Contains(HasSubstr("share the form")));
  for (RunResult& result : results) result.data_seed.reset();
  EXPECT_THAT(html::caveats(make_cases(results)), Not(Contains(HasSubstr("imulator"))));
}

TEST(Caveats, PassOnWhatTheRunnerNotedAboutTheScores) {
  std::vector<RunResult> results = synthetic_results({{"fusion", 0.06}}, 3);
  results[0].notes = results[2].notes = {"only 12 of 616 scans have a true pose"};
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains("synthetic-corridor: only 12 of 616 scans have a true pose (2 cases)"));
}

TEST(Caveats, NameMixedAndDirtyRevisions) {
  std::vector<RunResult> results = synthetic_results({{"fusion", 0.06}}, 2);
  results[0].git_revision = "1234567+dirty";
  EXPECT_THAT(html::caveats(make_cases(results)),
              AllOf(Contains(HasSubstr("2 revisions")), Contains(HasSubstr("+dirty"))));
}

TEST(Reproduce, GivesOneRunPerRevisionWithItsSystemsAndSeeds) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}, {"fusion", 0.01}}, 3);
  for (RunResult& result : results) {
    if (result.system == "fusion") result.git_revision = "1234567+dirty";
  }
  const std::string commands = html::reproduce_commands(make_cases(results));
  EXPECT_THAT(commands,
              AllOf(HasSubstr("git checkout 0000000\n"), HasSubstr("git checkout 1234567   # plus"),
                    HasSubstr("corridor-bench run synthetic --jobs 1 --seed 1 --seeds 3 --out "
                              "synthetic-0000000 \\\n    --system karto@default \\\n    --dataset "
                              "synthetic-corridor\n")));
}

TEST(Reproduce, SaysOfOldRecordsWhichSeriesWereSetByHand) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[1].parameters["num_particles"] = "99";
  results[1].parameters_hash = "fedcba";
  EXPECT_THAT(
      html::reproduce_commands(make_cases(results)),
      HasSubstr("# karto (num_particles=99): a run of its own, with --set SYSTEM.key=value\n"));
}

// The commands alone, without comments and with their lines joined.
std::vector<std::string> run_commands(const std::vector<RunResult>& results) {
  std::vector<std::string> commands;
  std::string command;
  std::istringstream lines(html::reproduce_commands(make_cases(results)));
  for (std::string line; std::getline(lines, line);) {
    const bool goes_on = line.ends_with("\\");
    command += goes_on ? line.substr(0, line.size() - 1) : line;
    if (goes_on) continue;
    command = std::regex_replace(command, std::regex(" +"), " ");
    if (command.starts_with("corridor-bench run")) commands.push_back(command);
    command.clear();
  }
  return commands;
}

TEST(Reproduce, SetsAgainWhatWasSetByHandAndNothingElse) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}, {"fusion", 0.01}}, 2);
  for (RunResult& result : results) {
    result.overrides.emplace();
    if (result.system == "karto") result.overrides = Texts{{"use_loop_closing", "false"}};
  }
  EXPECT_THAT(run_commands(results),
              ::testing::UnorderedElementsAre(
                  "corridor-bench run synthetic --jobs 1 --seed 1 --seeds 2 --out synthetic "
                  "--system fusion@default --dataset synthetic-corridor",
                  "corridor-bench run synthetic --jobs 1 --seed 1 --seeds 2 --out synthetic "
                  "--system karto@default --set 'karto.use_loop_closing=false' --dataset "
                  "synthetic-corridor"));
}

TEST(Reproduce, RunsEveryRangeOfSeedsByItselfAndNoOtherSeed) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 5);
  results.erase(results.begin() + 1);
  EXPECT_THAT(run_commands(results),
              ::testing::UnorderedElementsAre(HasSubstr(" --seed 1 --seeds 1 --out"),
                                              HasSubstr(" --seed 3 --seeds 3 --out")));
}

TEST(Reproduce, MultipliesNoSystemsByDataSetsThatTheyNeverSaw) {
  std::vector<RunResult> results =
      synthetic_results({{"karto", 0.06}, {"gmapping", 0.1}, {"fusion", 0.01}}, 1);
  for (RunResult& result : results) {
    if (result.system == "fusion") result.dataset = "with-imu";
  }
  EXPECT_THAT(
      run_commands(results),
      ::testing::UnorderedElementsAre(
          HasSubstr(
              "--system gmapping@default --system karto@default --dataset synthetic-corridor"),
          HasSubstr("--system fusion@default --dataset with-imu")));
}

TEST(Reproduce, NamesEachSystemsBackEnd) {
  std::vector<RunResult> results =
      synthetic_results({{"karto", 0.06}, {"gmapping", 0.1}, {"fusion", 0.01}}, 1);
  for (RunResult& result : results) {
    if (result.system != "gmapping") result.backend = "levenberg";
  }
  results.push_back(results.back());
  results.back().backend = "gauss-newton";
  EXPECT_THAT(run_commands(results),
              ::testing::UnorderedElementsAre(
                  HasSubstr("--system karto@default --system gmapping@default --backend levenberg "
                            "--dataset"),
                  HasSubstr("--system fusion@default --backend gauss-newton --backend levenberg "
                            "--dataset")));
}

TEST(Reproduce, LoadsOnesOwnLogFromWhereItWas) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 1);
  results[0].suite = "own";
  results[0].dataset = "full";
  results[0].data_source = "/data/my $log/full.rawlog";
  EXPECT_THAT(run_commands(results),
              ElementsAre("corridor-bench run --jobs 1 --seed 1 --seeds 1 --out own --system "
                          "karto@default --dataset '/data/my $log/full.rawlog'"));
}

TEST(Reproduce, SaysThatAnOldRecordDoesNotTellWhereALogLies) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 1);
  results[0].suite = "own";
  EXPECT_THAT(html::reproduce_commands(make_cases(results)),
              HasSubstr("# Where these data lie the record does not say"));
}

TEST(Reproduce, KeepsRevisionsAndLogsOfOneNameInFoldersOfTheirOwn) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 3);
  for (RunResult& result : results) result.data_source = "/a/log.rawlog";
  results[1].git_revision = "1234567890+dirty";
  results[2].data_source = "/b/log.rawlog";
  EXPECT_THAT(run_commands(results),
              ::testing::UnorderedElementsAre(HasSubstr("--out synthetic-0000000 "),
                                              HasSubstr("--out synthetic-0000000-2 "),
                                              HasSubstr("--out synthetic-1234567-dirty ")));
}

TEST(SetByHand, NeverPassesForShipped) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}, {"fusion-paper", 0.02}}, 2);
  for (RunResult& result : results) {
    result.profile = "as-shipped";
    result.overrides.emplace();
    if (result.system == "karto") result.overrides = Texts{{"use_loop_closing", "false"}};
  }
  const Cases cases = make_cases(results);
  EXPECT_EQ(cases.label(cases.series().front()), "karto (set: use_loop_closing=false)");
  EXPECT_FALSE(tables::is_paper_counterpart(cases, cases.series().front()));
  EXPECT_TRUE(tables::is_paper_counterpart(cases, cases.series().back()));
  const std::string errors = tables::to_csv(tables::trajectory_error_table(cases));
  EXPECT_THAT(errors, AllOf(Not(HasSubstr("0.6032")), HasSubstr("0.1949")));
  const std::string lengths = tables::to_csv(tables::key_distance_table(cases));
  EXPECT_THAT(lengths, AllOf(Not(HasSubstr("13.415")), HasSubstr("13.897")));
  EXPECT_THAT(html::caveats(cases),
              Contains(AllOf(StartsWith("Profile as-shipped"), HasSubstr("get: fusion-paper."))));
}

TEST(SetByHand, LeavesTheShippedSeriesItsNameAndThePapersValue) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[0].overrides.emplace();
  results[1].overrides = Texts{{"num_particles", "99"}};
  results[1].parameters_hash = "fedcba";
  const Cases cases = make_cases(results);
  EXPECT_EQ(cases.label(cases.series()[0]), "karto");
  EXPECT_EQ(cases.label(cases.series()[1]), "karto (set: num_particles=99)");
  EXPECT_TRUE(tables::is_paper_counterpart(cases, cases.series()[0]));
}

TEST(SetByHand, IsUnknownOfOldRecordsAndSaidToBe) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[0].overrides.emplace();
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(HasSubstr("records of 1 of 2 cases do not say which parameters were set")));
  results[1].overrides.emplace();
  EXPECT_THAT(html::caveats(make_cases(results)), Not(Contains(HasSubstr("set by hand:"))));
}

TEST(Caveats, ClaimOtherSeedsThanThoseOfDevelopmentOnlyIfAllAre) {
  std::vector<RunResult> results = synthetic_results({{"fusion", 0.06}}, 3);
  for (RunResult& result : results) *result.data_seed += 1000;
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(HasSubstr("with other seeds than these")));
  results[0].data_seed = 7;
  const auto sentences = html::caveats(make_cases(results));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("development seeds are in this report"),
                                        HasSubstr("1 of 3 simulated cases have one (7)"))));
  EXPECT_THAT(sentences, Not(Contains(HasSubstr("with other seeds than these"))));
}

}  // namespace
}  // namespace corridor::reports
