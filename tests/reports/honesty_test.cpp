// What a report says about the limits of its own numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<RunResult> synthetic_results(std::vector<testing::SyntheticSystem> systems,
                                         std::uint64_t num_worlds = 8) {
  testing::SyntheticRun run;
  run.systems = std::move(systems);
  std::vector<RunResult> all;
  for (const testing::SyntheticSystem& system : run.systems) {
    for (std::uint64_t seed = 1; seed <= num_worlds; ++seed) {
      all.push_back(testing::synthetic_result(run, system, seed));
    }
  }
  return all;
}

Cases make_cases(const std::vector<RunResult>& results) {
  std::vector<Case> cases;
  for (const RunResult& result : results) cases.push_back({result, {}});
  return {std::move(cases), {}, {}};
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
    if (result.system == "karto") result.profile = "shipped";
  }
  EXPECT_THAT(html::caveats(make_cases(results)),
              Contains(AllOf(StartsWith("Profile shipped"), HasSubstr("get: karto."))));
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
                              "synthetic \\\n    --system karto@default \\\n    --dataset "
                              "synthetic-corridor\n")));
}

TEST(Reproduce, NamesVariantsThatWereSetByHand) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 2);
  results[1].parameters["num_particles"] = "99";
  results[1].parameters_hash = "fedcba";
  EXPECT_THAT(html::reproduce_commands(make_cases(results)),
              HasSubstr("# karto (num_particles=99): a run of its own, with --set\n"));
}

TEST(Reproduce, NamesSeedsThatAreNotConsecutive) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 5);
  results.erase(results.begin() + 1);
  EXPECT_THAT(html::reproduce_commands(make_cases(results)), HasSubstr("# seeds 1, 3 to 5 only:"));
}

TEST(Reproduce, RunsOnesOwnLogWithoutASuite) {
  std::vector<RunResult> results = synthetic_results({{"karto", 0.06}}, 1);
  results[0].suite = "own";
  results[0].dataset = "my $log";
  EXPECT_THAT(html::reproduce_commands(make_cases(results)),
              AllOf(HasSubstr("corridor-bench run --jobs 1"), HasSubstr("--dataset 'my $log'")));
}

}  // namespace
}  // namespace corridor::reports
