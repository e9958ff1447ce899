// What the page's sentences claim, and what they leave open.
#include "reports/html/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/html/caveats.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"
#include "tests/reports/synthetic_run.hpp"

namespace corridor::reports {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_of;
using ::testing::StartsWith;

Cases synthetic_cases(const testing::SyntheticRun& run, std::uint64_t num_worlds = 8) {
  return testing::make_cases(testing::synthetic_results(run, num_worlds));
}

std::vector<std::string> all_sentences(const Cases& cases) {
  std::vector<std::string> sentences;
  for (const html::Verdict& verdict : html::verdicts(cases)) {
    sentences.insert(sentences.end(), verdict.sentences.begin(), verdict.sentences.end());
    sentences.insert(sentences.end(), verdict.details.begin(), verdict.details.end());
  }
  return sentences;
}

TEST(Verdicts, FollowTheNumbersAndNotTheNames) {
  testing::SyntheticRun run = testing::paper_like_run();
  for (testing::SyntheticSystem& system : run.systems) {
    if (system.name == "fusion") system.shrink_ratio = 0.3;  // now the worst of all
  }
  const auto sentences = all_sentences(synthetic_cases(run));
  EXPECT_THAT(sentences,
              Contains(AllOf(StartsWith("The position error of fusion is"),
                             HasSubstr("the largest median of 5"),
                             HasSubstr("It is shown to be larger than that of all 4 others"))));
  EXPECT_THAT(sentences, Contains(HasSubstr("All 40 cases ended with status ok.")));
}

TEST(Verdicts, NameTheSmallestLeadAmongAllOtherSystemsWithRatioIntervalAndCount) {
  auto run = run_of({{"dead-reckoning", 0.05},
                     {"mrpt-icp", 0.2},
                     {"mrpt-rbpf", 0.1},
                     {"fusion-paper", 0.02},
                     {"fusion", 0.01}});
  EXPECT_THAT(all_sentences(synthetic_cases(run)),
              Contains(AllOf(
                  StartsWith("The position error of fusion is 0.096 m ["),
                  HasSubstr("n = 8 of 8 worlds, the smallest median of 5"),
                  HasSubstr("smaller than that of all 4 others, closest fusion-paper: ratio 0.500 "
                            "[0.500, 0.500], n = 8."))));
}

TEST(Verdicts, SayOfTheGyroAloneWhatItBeats) {
  auto run = run_of({{"dead-reckoning-gyro", 0.02}, {"gmapping", 0.08}, {"fusion", 0.01}});
  EXPECT_THAT(all_sentences(synthetic_cases(run)),
              Contains(AllOf(StartsWith("The position error of dead-reckoning-gyro is"),
                             HasSubstr("smaller than that of gmapping (ratio 0.250"),
                             HasSubstr("larger than that of fusion (ratio 2.000"))));
}

TEST(Verdicts, ClaimNoDifferenceThatTheIntervalDoesNotShow) {
  const auto run = run_of({{"karto", 0.02, 0}, {"fusion", 0.02, 0.09}});  // now better, now worse
  const auto sentences = all_sentences(synthetic_cases(run));
  EXPECT_THAT(sentences, Contains(AllOf(StartsWith("The position error of fusion is"),
                                        HasSubstr("It is not shown to differ from that of karto "
                                                  "(ratio "))));
  EXPECT_THAT(sentences, Not(Contains(HasSubstr("shown to be smaller"))));
}

TEST(Verdicts, SayThatALeadWasWonInFewerWorlds) {
  const auto run = run_of({{"karto", 0.06}, {"fusion", 0.01}});
  std::vector<Case> all = synthetic_cases(run).all();
  for (Case& entry : all) {
    if (entry.result.system != "fusion" || entry.result.data_seed != 3U) continue;
    entry.result.status = results::CaseStatus::kPartial;
  }
  EXPECT_THAT(all_sentences(Cases(all, {}, {})),
              Contains(AllOf(HasSubstr("(n = 7 of 8 worlds, the smallest median of 2)"),
                             HasSubstr("It gave a value in fewer worlds than karto."))));
}

TEST(Verdicts, OfTooFewWorldsCompareNothing) {
  const auto run = run_of({{"karto", 0.06}, {"fusion", 0.01}});
  const auto sentences = all_sentences(synthetic_cases(run, 5));
  EXPECT_THAT(sentences,
              ElementsAre("Too few worlds for a verdict (5 at most, 6 are needed): see the tables.",
                          "All 10 cases ended with status ok."));
}

TEST(Verdicts, OfRecordedDataCountRunsAndNotWorlds) {
  std::vector<Case> all = synthetic_cases(run_of({{"karto", 0.06}}), 3).all();
  for (Case& entry : all) entry.result.system_seed = *entry.result.data_seed;
  for (Case& entry : all) entry.result.data_seed.reset();
  EXPECT_THAT(all_sentences(Cases(all, {}, {})),
              Contains(StartsWith("Too few runs for a verdict (3 at most, 6 are needed;")));
}

TEST(Verdicts, OfDataWithoutTruthSendTheReaderToTheMaps) {
  std::vector<Case> all = synthetic_cases(run_of({{"karto", 0.06}}), 1).all();
  all[0].result.dataset = "malaga";
  all[0].result.data_seed.reset();
  all[0].result.final_scores = all[0].result.online_scores = {};
  const Cases cases(all, {}, {});
  EXPECT_THAT(all_sentences(cases), Contains("malaga: no truth is known; look at the maps."));
  EXPECT_THAT(all_sentences(cases), Contains(StartsWith("1 of those that ended are not scored")));
  const tables::Table table = tables::outcome_table(cases);
  EXPECT_THAT(tables::to_csv(table), HasSubstr("malaga,karto,1,0,0,0,0,0,0,0,1"));
  EXPECT_THAT(table.notes, Contains(StartsWith("ended; not scored: no true poses, no relations.")));
  EXPECT_THAT(html::caveats(cases), Contains(StartsWith("malaga: not scored:")));
}

TEST(Verdicts, OfOneSystemCompareNothing) {
  EXPECT_THAT(all_sentences(synthetic_cases(run_of({{"karto", 0.06}}))),
              Contains(AllOf(StartsWith("The position error of karto is"),
                             HasSubstr("no other one was measured"))));
}

TEST(Verdicts, SayThatTheMapIsTooShort) {
  EXPECT_THAT(all_sentences(synthetic_cases(run_of({{"karto", 0.06, 0.01}}))),
              Contains(HasSubstr("b is too short: measured - true = -1.249 m")));
}

TEST(Verdicts, AnswerEachQuestionInOneSentenceAndKeepTheRestInTheDetails) {
  const auto run = run_of({{"karto", 0.06, 0.01}, {"fusion-paper", 0.02, 0.01}, {"fusion", 0.01}});
  const html::Verdict verdict = html::verdicts(synthetic_cases(run)).front();
  EXPECT_THAT(
      verdict.sentences,
      ElementsAre(StartsWith("The position error of fusion is"),
                  StartsWith("The angle error of fusion is"),
                  StartsWith("The published method (fusion-paper) reduces karto's position"),
                  StartsWith("The published method (fusion-paper) reduces karto's angle"),
                  StartsWith("On the systems' own maps, a is too short for "),
                  AllOf(StartsWith("On the systems' own maps, b is too short for "),
                        HasSubstr("karto (by 1.249 m)"))));
  EXPECT_THAT(verdict.details, Contains(StartsWith("The position error of fusion-paper is")));
  EXPECT_THAT(verdict.details, Contains(StartsWith("On karto's own map a ")));
}

// The paper: 1 - 0.1949 / 0.6032 and 1 - 0.674 / 0.923.
TEST(Verdicts, HoldThePublishedMethodAgainstItsPapersClaims) {
  const auto reached = run_of({{"karto", 0.06, 0.01}, {"fusion-paper", 0.01, 0.01}});
  EXPECT_THAT(all_sentences(synthetic_cases(reached)),
              Contains(AllOf(HasSubstr("reduces karto's position error by 83.3 % ["),
                             HasSubstr("the paper claims 67.69 %: the whole interval is beyond"))));
  const auto missed = run_of({{"karto", 0.06, 0.01}, {"fusion-paper", 0.058, 0.01}});
  EXPECT_THAT(all_sentences(synthetic_cases(missed)),
              Contains(AllOf(HasSubstr("reduces karto's angle error by "),
                             HasSubstr("the paper claims 26.98 %: not reached here."),
                             HasSubstr("karto's own angle error is "),
                             HasSubstr("0.923 deg in the paper"))));
  const auto without_rival = run_of({{"gmapping", 0.06, 0.01}, {"fusion-paper", 0.01, 0.01}});
  EXPECT_THAT(all_sentences(synthetic_cases(without_rival)),
              Not(Contains(HasSubstr("the paper claims"))));
}

TEST(Verdicts, NameTheSystemWhoseCasesFailed) {
  const auto run = run_of({{"mrpt-icp", 0.06}});
  auto lost = testing::synthetic_result(run, run.systems[0], 1);
  lost.status = results::CaseStatus::kDiverged;
  const auto fine = testing::synthetic_result(run, run.systems[0], 2);
  EXPECT_THAT(all_sentences(Cases({{lost, {}}, {fine, {}}}, {}, {})),
              AllOf(Contains("1 of 2 cases did not end with status ok."),
                    Contains("mrpt-icp on synthetic-corridor: 1 of 2 diverged.")));
}

}  // namespace
}  // namespace corridor::reports
