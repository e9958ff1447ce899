// Pose graphs with false loop closures in a report: which cases they are, what counts as a success,
// their table, figure and sentence.
#include "reports/false_closures.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "reports/figures/report_figures.hpp"
#include "reports/html/verdict.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::reports {
namespace {

using results::RunResult;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// `percent` of the closures false, all of them and one true one rejected.
RunResult disturbed(const std::string& method, int percent, double gap_ratio, std::uint64_t seed) {
  RunResult result;
  result.profile = fmt::format("{}-false-{}", method, percent);
  result.case_id = fmt::format("{}-{}", result.profile, seed);
  result.suite = "false-closures";
  result.system = "graph-batch";
  result.backend = "gauss-newton";
  result.dataset = "a";
  result.data_kind = "graph";
  result.system_seed = seed;
  result.parameters = {{"robust", method},
                       {"false_closures", fmt::format("{}", percent / 100.0)},
                       {"false_pairs", "random"},
                       {"start", "odometry"}};
  result.parameters_hash = result.profile;
  result.status = results::CaseStatus::kOk;
  result.chi2 = 100 * (1 + gap_ratio);
  result.chi2_best = 100;
  result.chi2_gap_ratio = gap_ratio;
  result.wall_s = 1;
  if (percent > 0) result.false_closures = percent;
  if (method == "none") return result;
  result.rejected_closures = percent + 1;
  if (percent == 0) return result;
  result.rejection_precision = percent / (percent + 1.0);
  result.rejection_recall = 1;
  return result;
}

Cases cases_of(const std::vector<RunResult>& results) {
  std::vector<Case> cases;
  for (const RunResult& result : results) cases.push_back({result, result.case_id});
  return Cases(std::move(cases), {}, {});
}

// The same start with nothing planted, of a suite that is not about false closures.
RunResult undisturbed() {
  RunResult result = disturbed("none", 0, 0, 1);
  result.suite = "backends";
  result.profile = result.case_id = "odometry";
  return result;
}

std::vector<std::string> profiles_of(const Cases& cases) {
  std::vector<std::string> profiles;
  for (const Case& entry : cases.all()) profiles.push_back(entry.result.profile);
  return profiles;
}

TEST(FalseClosures, AreCasesWithPlantedOnesOrAMethodAndTheirOwnSuitesBaseline) {
  const Cases cases = cases_of({disturbed("none", 30, 9, 1), disturbed("gnc", 0, 0, 1),
                                disturbed("none", 0, 0, 1), undisturbed()});
  EXPECT_THAT(profiles_of(with_false_closures(cases)),
              ElementsAre("gnc-false-0", "none-false-0", "none-false-30"));
  EXPECT_THAT(profiles_of(without_false_closures(cases)), ElementsAre("odometry"));
}

TEST(FalseClosures, AreNoneWhereNothingWasPlantedAndNothingLookedForThem) {
  RunResult old = undisturbed();
  old.parameters.clear();
  const Cases cases = cases_of({old, disturbed("none", 0, 0, 1)});
  EXPECT_TRUE(with_false_closures(cases).all().empty());
  EXPECT_EQ(without_false_closures(cases).all().size(), 2U);
}

TEST(FalseClosures, LeaveAGraphFoundAgainWithinAQuarterOfTheBest) {
  RunResult result = disturbed("gnc", 50, 0.24, 1);
  EXPECT_TRUE(is_found_again(result));
  result.chi2 = 126;
  EXPECT_FALSE(is_found_again(result));
  result.chi2.reset();
  EXPECT_FALSE(is_found_again(result)) << "nothing measured is no success";
  result.chi2 = 100;
  result.status = results::CaseStatus::kDiverged;
  EXPECT_FALSE(is_found_again(result));
}

TEST(FalseClosureTable, HasARowPerGraphMethodAndShareWithSuccessGapAndRejection) {
  const tables::Table table = tables::false_closure_table(with_false_closures(cases_of(
      {disturbed("gnc", 50, 0.1, 1), disturbed("gnc", 50, 0.5, 2), disturbed("gnc", 50, 0.2, 3),
       disturbed("gnc", 10, 0, 1), disturbed("none", 50, 700, 1)})));
  ASSERT_EQ(table.rows.size(), 3U);
  const auto text = [&](std::size_t row, std::size_t column) {
    return std::get<std::string>(table.rows[row][column]);
  };
  EXPECT_EQ(text(0, 2), "none") << "what does nothing comes first";
  EXPECT_EQ(text(0, 4), "0/1");
  EXPECT_EQ(text(1, 3), "10");
  EXPECT_EQ(text(2, 2), "gnc");
  EXPECT_EQ(text(2, 3), "50");
  EXPECT_EQ(text(2, 4), "2/3");
  EXPECT_EQ(text(2, 5), "0.21 to 0.94");
  EXPECT_EQ(text(2, 6), "2.0e-01");
  EXPECT_EQ(text(2, 7), "5.0e-01");
  const auto& precision = std::get<tables::Estimate>(table.rows[2][10]);
  EXPECT_DOUBLE_EQ(precision.median, 50.0 / 51);
  EXPECT_EQ(precision.n, 3);
  EXPECT_TRUE(std::holds_alternative<tables::Missing>(table.rows[0][10])) << "nothing looked";
  EXPECT_THAT(tables::to_markdown(table), HasSubstr("at most 25 % above the best known"));
}

TEST(ReportTables, KeepFalseClosuresOutOfTheTableOfBackEnds) {
  std::vector<std::string> ids;
  for (const tables::Table& table :
       tables::report_tables(cases_of({disturbed("gnc", 30, 0, 1), disturbed("none", 0, 0, 1)}))) {
    ids.push_back(table.id);
  }
  EXPECT_THAT(ids, ElementsAre("false-closures", "outcomes"));
}

TEST(FalseClosureFigure, HasALinePerMethodAndAPanelPerGraph) {
  RunResult other = disturbed("dcs", 50, 0, 1);
  other.dataset = "b";
  const Cases cases = with_false_closures(
      cases_of({disturbed("gnc", 0, 0, 1), disturbed("gnc", 50, 9, 1), disturbed("gnc", 50, 0, 2),
                disturbed("none", 50, 700, 1), other}));
  const auto figure = figures::false_closure_figure(cases, "gauss-newton");
  ASSERT_TRUE(figure.has_value());
  EXPECT_EQ(figure->svg.id(), "false-closures-gauss-newton");
  const std::string svg = figure->svg.file();
  for (const char* text : {">a: share of runs", ">b: share of runs", ">none<", ">dcs<", ">gnc<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_THAT(figure->caption, HasSubstr("shares of 1 to 2 runs"));
  EXPECT_FALSE(figures::false_closure_figure(cases, "ceres").has_value());
  EXPECT_FALSE(figures::false_closure_figure(cases_of({disturbed("gnc", 0, 0, 1)}), "gauss-newton")
                   .has_value())
      << "nothing planted";
}

TEST(FalseClosureFigure, NeverPoolsWhatWasPlantedOtherwise) {
  RunResult local = disturbed("gnc", 50, 0, 1);
  local.parameters["false_pairs"] = "local";
  local.parameters_hash = local.profile = "local";
  const auto figure = figures::false_closure_figure(
      with_false_closures(cases_of({local, disturbed("gnc", 50, 9, 1)})), "gauss-newton");
  ASSERT_TRUE(figure.has_value());
  const std::string svg = figure->svg.file();
  EXPECT_THAT(svg, HasSubstr("gnc (false_pairs local)"));
  EXPECT_THAT(svg, HasSubstr("gnc (false_pairs random)"));
}

TEST(FalseClosureFigure, DrawsEveryMethodInItsOwnStyle) {
  std::vector<RunResult> results;
  for (const char* method :
       {"none", "huber", "cauchy", "geman-mcclure", "dcs", "gnc", "gnc-geman-mcclure", "pcm"}) {
    results.push_back(disturbed(method, 50, 0, 1));
  }
  const auto figure = figures::false_closure_figure(cases_of(results), "gauss-newton");
  ASSERT_TRUE(figure.has_value());
  const std::string svg = figure->svg.file();
  std::set<std::string> styles;
  const std::string drawn = "\"path line-";
  for (std::size_t at = svg.find(drawn); at != std::string::npos; at = svg.find(drawn, at + 1)) {
    styles.insert(svg.substr(at, svg.find('"', at + 1) - at));
  }
  EXPECT_EQ(styles.size(), results.size());
}

TEST(InitialNoiseFigure, HasALinePerBackEndOverTheNoiseAndNoneWithout) {
  std::vector<RunResult> results;
  for (const char* backend : {"gauss-newton", "ceres"}) {
    for (const char* sigma_rad : {"0.1", "0.4"}) {
      RunResult result = undisturbed();
      result.backend = backend;
      result.profile = std::string("near-") + sigma_rad;
      result.case_id = result.profile + backend;
      result.parameters["start_heading_sigma_rad"] = sigma_rad;
      result.parameters["start_position_sigma_m"] = sigma_rad[2] == '1' ? "1" : "4";
      results.push_back(result);
    }
  }
  const auto figure = figures::initial_noise_figure(cases_of(results));
  ASSERT_TRUE(figure.has_value());
  const std::string svg = figure->svg.file();
  EXPECT_THAT(svg, HasSubstr(">gauss-newton<"));
  EXPECT_THAT(svg, HasSubstr(">ceres<"));
  EXPECT_FALSE(figures::initial_noise_figure(cases_of({undisturbed()})).has_value());
}

std::vector<std::string> sentences_on_a(const std::vector<RunResult>& results) {
  return html::verdicts(cases_of(results)).front().sentences;
}

TEST(Verdict, SaysWhichMethodFoundTheGraphAgainWithHalfOfItsClosuresFalse) {
  EXPECT_THAT(sentences_on_a({disturbed("none", 50, 700, 1), disturbed("gnc", 50, 0.1, 1),
                              disturbed("gnc", 50, 9, 2), disturbed("gnc", 30, 0, 1)}),
              ElementsAre("With 50 % of the closures false found again by: "
                          "gnc 1 of 2 [0.09, 0.91]; none 0 of 1 [0.00, 0.79]."));
}

TEST(Verdict, TellsTwoBackEndsWithOneMethodApart) {
  RunResult other = disturbed("gnc", 50, 9, 1);
  other.backend = "ceres";
  other.case_id += "ceres";
  EXPECT_THAT(sentences_on_a({disturbed("gnc", 50, 0, 1), other}),
              ElementsAre(HasSubstr("gnc (graph-batch/gauss-newton) 1 of 1 [0.21, 1.00]; "
                                    "gnc (graph-batch/ceres) 0 of 1 [0.00, 0.79].")));
}

TEST(Verdict, SaysNothingOfMethodsThatWereNotRunWithHalfOfTheClosuresFalse) {
  EXPECT_THAT(sentences_on_a({disturbed("gnc", 30, 0, 1)}),
              ElementsAre("No verdict on false closures: nothing was run with 50 % of them."));
}

TEST(Verdict, OfBackEndsLeavesFalseClosuresOut) {
  RunResult solved = undisturbed();
  solved.wall_s = 2;
  EXPECT_THAT(sentences_on_a({solved, disturbed("gnc", 50, 0, 1)}),
              ElementsAre("Solved every time by 1 of 1 ways and back-ends.",
                          "Least time: graph-batch, median 2 s over 1 run.",
                          HasSubstr("by: gnc 1 of 1 [0.21, 1.00].")));
}

TEST(Verdict, CountsGraphsLostAmongFalseClosuresOnceAndNamesEveryOtherFailure) {
  RunResult lost = disturbed("none", 50, 700, 1), late = disturbed("gnc", 50, 0, 1);
  lost.status = results::CaseStatus::kDiverged;
  late.status = results::CaseStatus::kTimeout;
  EXPECT_THAT(html::verdicts(cases_of({lost, late, disturbed("gnc", 10, 0, 1)})).back().sentences,
              ElementsAre("2 of 3 cases did not end with status ok.",
                          "1 of these diverged with false closures or a robust method: see table "
                          "false-closures.",
                          "graph-batch@gnc-false-50 on a: 1 of 1 timeout."));
}

}  // namespace
}  // namespace corridor::reports
