// Pose graphs in a report: what counts as solved, the tables, the figures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reports/figures/report_figures.hpp"
#include "reports/graph_cases.hpp"
#include "reports/html/verdict.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::reports {
namespace {

results::RunResult graph_result(const std::string& backend, const std::string& dataset,
                                double wall_s, double gap_ratio, std::uint64_t seed = 1) {
  results::RunResult result;
  result.case_id = fmt::format("{}-{}-{}", dataset, backend, seed);
  result.suite = "backends";
  result.system = "graph-batch";
  result.profile = "odometry";
  result.backend = backend;
  result.dataset = dataset;
  result.data_kind = "graph";
  result.system_seed = seed;
  result.status = results::CaseStatus::kOk;
  result.chi2 = 100 * (1 + gap_ratio);
  result.chi2_best = 100;
  result.chi2_gap_ratio = gap_ratio;
  result.variables = 10;
  result.wall_s = wall_s;
  return result;
}

Cases cases_of(const std::vector<results::RunResult>& results,
               const std::filesystem::path& folder = {}) {
  std::vector<Case> cases;
  for (const results::RunResult& result : results) {
    cases.push_back({result, folder / result.case_id});
  }
  return Cases(std::move(cases), {}, {});
}

// `fast` needs half of the time of `slow` on graph a, `slow` alone solves b.
Cases two_back_ends() {
  return cases_of({graph_result("fast", "a", 1, 1e-9), graph_result("slow", "a", 2, 1e-9),
                   graph_result("fast", "b", 1, 1e-3), graph_result("slow", "b", 5, -1e-12)});
}

TEST(GraphCases, AreSolvedWithinAMillionthAtOnceAndWithinHalfAPerMillePoseByPose) {
  results::RunResult result = graph_result("fast", "a", 1, 1e-4);
  EXPECT_FALSE(is_solved(result));
  result.step_max_us = 10;
  EXPECT_TRUE(is_solved(result));
  result.status = results::CaseStatus::kDiverged;
  EXPECT_FALSE(is_solved(result));
  EXPECT_TRUE(is_solved(graph_result("fast", "a", 1, -0.1))) << "better than the best known";
  result = graph_result("fast", "a", 1, 0);
  result.chi2.reset();
  EXPECT_FALSE(is_solved(result));
  result.chi2 = 1e-10;
  result.chi2_best = 0;
  EXPECT_TRUE(is_solved(result)) << "where every measurement can be met there is no ratio";
  result.chi2 = 1e-8;
  EXPECT_FALSE(is_solved(result));
}

TEST(BackEndTable, HasAnIntervalOfTheShareOnlyWhereSeedsDraw) {
  std::vector<results::RunResult> repeats;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    repeats.push_back(graph_result("fast", "a", 1, 0, seed));
    repeats.push_back(graph_result("slow", "a", 1, 0, seed));
    repeats.back().parameters["start_heading_sigma_rad"] = "0.1";
  }
  const tables::Table table = tables::back_end_table(cases_of(repeats));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(std::get<std::string>(table.rows[0][2]), "8/8");
  EXPECT_TRUE(std::holds_alternative<tables::Missing>(table.rows[0][3])) << "one run, eight times";
  EXPECT_EQ(std::get<std::string>(table.rows[1][3]), "0.68 to 1.00");
  EXPECT_FALSE(std::get<tables::Estimate>(table.rows[0][5]).low) << "chi2 is the same every time";
}

TEST(BackEndTable, HasARowPerGraphAndBackEndWithTheWorstGapAndTheShareSolved) {
  const tables::Table table = tables::back_end_table(two_back_ends());
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(std::get<std::string>(table.rows[2][0]), "b");
  EXPECT_EQ(std::get<std::string>(table.rows[2][2]), "0/1");
  EXPECT_EQ(std::get<std::string>(table.rows[2][4]), "1.0e-03");
  EXPECT_EQ(std::get<std::string>(table.rows[3][2]), "1/1");
  EXPECT_TRUE(tables::back_end_run_table(two_back_ends()).rows.empty()) << "nothing pose by pose";
}

TEST(BackEndRatioTable, DividesRepeatByRepeatByTheTimesOfCeresFromOdometry) {
  std::vector<results::RunResult> results;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto time_s = static_cast<double>(seed);
    results.push_back(graph_result("ceres", "a", time_s, 1e-9, seed));
    results.push_back(graph_result("fast", "a", time_s / 4, 1e-9, seed));
    results.push_back(graph_result("lost", "a", time_s / 8, 1e-3, seed));
    results.push_back(graph_result("few", "a", time_s, seed < 6 ? 1e-9 : 1e-3, seed));
  }
  const tables::Table table = tables::back_end_ratio_table(cases_of(results));
  ASSERT_EQ(table.rows.size(), 3U) << "lost has no row";
  for (const auto& row : table.rows) {
    EXPECT_EQ(std::get<std::string>(row[2]), "odometry");
    EXPECT_EQ(std::get<tables::Missing>(row[4]).reason, "reference not run");
    const std::string name = std::get<std::string>(row[1]);
    if (name.find("few") != std::string::npos) {
      EXPECT_EQ(std::get<tables::Missing>(row[3]).reason, "fewer than 6 pairs");
    } else {
      const double ratio = name.find("fast") != std::string::npos ? 0.25 : 1.0;
      EXPECT_EQ(std::get<tables::Estimate>(row[3]).median, ratio);
      EXPECT_EQ(std::get<tables::Estimate>(row[3]).n, 6);
    }
  }
}

TEST(BackEndRatioTable, HasNoRowWhereNoReferenceWasRun) {
  EXPECT_TRUE(tables::back_end_ratio_table(two_back_ends()).rows.empty());
}

TEST(BackEndRatioTable, StartsTheReferenceWhereItSolvesTheGraph) {
  std::vector<results::RunResult> results;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    results.push_back(graph_result("ceres", "hard", 1, 1, seed));
    results.push_back(graph_result("ceres", "hard", 2, 1e-9, seed));
    results.back().profile = "chordal";
    results.back().case_id += "-chordal";
  }
  const tables::Table table = tables::back_end_ratio_table(cases_of(results));
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(std::get<std::string>(table.rows[0][2]), "chordal");
  EXPECT_EQ(std::get<tables::Estimate>(table.rows[0][3]).median, 1.0);
}

TEST(ReportTables, KeepGraphsOutOfTheTablesOfLogsAndFailuresInTheirs) {
  results::RunResult lost = graph_result("fast", "a", 1, 5);
  lost.status = results::CaseStatus::kDiverged;
  lost.status_message = "lost: chi2 600";
  std::vector<std::string> ids;
  for (const tables::Table& table : tables::report_tables(cases_of({lost}))) {
    ids.push_back(table.id);
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"backends", "outcomes", "failures"}));
}

TEST(Verdict, SaysWhoSolvedAGraphInTheLeastTime) {
  const auto verdicts = html::verdicts(two_back_ends());
  ASSERT_EQ(verdicts.size(), 3U) << "two graphs, all cases";
  EXPECT_EQ(verdicts[0].sentences,
            (std::vector<std::string>{"Solved every time by 2 of 2 ways and back-ends.",
                                      "Least time: graph-batch/fast, median 1 s over 1 run."}));
  EXPECT_EQ(verdicts[1].sentences[0], "Solved every time by 1 of 2 ways and back-ends.");
}

TEST(ProfileFigure, CountsAProblemOnlyForThoseThatSolveIt) {
  const auto figure = figures::profile_figure(two_back_ends(), "graph-batch");
  ASSERT_TRUE(figure.has_value());
  const std::string svg = figure->svg.file();
  EXPECT_NE(svg.find("fast: 1/2 solved"), std::string::npos);
  EXPECT_NE(svg.find("slow: 2/2 solved"), std::string::npos);
  EXPECT_FALSE(figures::profile_figure(two_back_ends(), "graph-incremental").has_value());
  EXPECT_FALSE(figures::profile_figure(cases_of({graph_result("fast", "a", 1, 0)}), "graph-batch")
                   .has_value())
      << "nobody to compare with";
}

TEST(ProfileFigure, LeavesOutWhatNotEveryBackEndWasGiven) {
  const auto figure = figures::profile_figure(
      cases_of({graph_result("fast", "a", 1, 0), graph_result("slow", "a", 2, 0),
                graph_result("fast", "b", 1, 0)}),
      "graph-batch");
  ASSERT_TRUE(figure.has_value());
  EXPECT_NE(figure->svg.file().find("fast: 1/1 solved"), std::string::npos);
  EXPECT_FALSE(figures::profile_figure(
                   cases_of({graph_result("fast", "a", 1, 0), graph_result("slow", "b", 2, 0)}),
                   "graph-batch")
                   .has_value());
}

// A run of 1000 updates that take poses^1.5 us, with a checkpoint at every hundredth.
std::string updates_text() {
  std::string text =
      "update,newest_pose,poses,time_us,relinearised,eliminated,factor_nonzeros,chi2,chi2_optimum,"
      "newest_gap_m,"
      "newest_gap_rad\n";
  for (int k = 0; k < 1000; ++k) {
    text += fmt::format("{},{},{},{},1,2,3,{}\n", k, k, k + 1, std::pow(k + 1, 1.5),
                        k % 100 == 99 ? "11,10,0.5,0.1" : ",,,");
  }
  return text;
}

TEST(UpdateFigures, FitTheGrowthAndShowTheGap) {
  const testing::ScratchFolder folder;
  results::RunResult result = graph_result("isam2", "a", 1, 0);
  result.step_max_us = 10;
  folder.write(result.case_id + "/updates.csv", updates_text());
  const Cases cases = cases_of({result}, folder.path());
  std::vector<std::string> problems;
  const auto times = figures::update_figure(cases, "a", problems);
  ASSERT_TRUE(times.has_value());
  EXPECT_NE(times->svg.file().find("grows as n^1.50"), std::string::npos);
  EXPECT_TRUE(figures::gap_figure(cases, "a", problems).has_value());
  EXPECT_TRUE(problems.empty());
}

TEST(UpdateFigures, SayWhatTheyCannotRead) {
  const testing::ScratchFolder folder;
  results::RunResult result = graph_result("isam2", "a", 1, 0);
  result.step_max_us = 10;
  for (const char* broken : {"names\n0,0,1\n", "names\n0,0,one,5,1,2,,,,,\n",
                             "names\n0,0,1,5,1,2,,,,,,\n", "names\n\n"}) {
    folder.write(result.case_id + "/updates.csv", broken);
    std::vector<std::string> problems;
    EXPECT_FALSE(figures::update_figure(cases_of({result}, folder.path()), "a", problems));
    ASSERT_EQ(problems.size(), 1U) << broken;
    EXPECT_NE(problems[0].find("updates.csv:2"), std::string::npos) << problems[0];
  }
}

}  // namespace
}  // namespace corridor::reports
