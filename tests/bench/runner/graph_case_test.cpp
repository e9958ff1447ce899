// Cases that solve pose graphs, from suite to record.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "bench/results/result_json.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/graph_task.hpp"
#include "bench/runner/plan.hpp"
#include "bench/runner/run_case.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "tests/bench/runner/plans.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

using results::CaseStatus;
using testing::plan_of;
using testing::suite_of;

// Solved within a millisecond.
constexpr const char* kWalk = "walk-200-s1";

CaseSpec only_case(const std::string& system, const std::string& backend,
                   const std::string& dataset = "walk-300-s5") {
  Suite suite = suite_of({system}, {dataset});
  suite.backends = {backend};
  return plan_of(suite).cases.at(0);
}

class GraphCase : public ::testing::Test {
 protected:
  results::RunResult run(const CaseSpec& spec) {
    const auto result = run_case(spec, catalog::DataDirs{}, folder_.path(), 1);
    EXPECT_TRUE(result.has_value()) << result.error().error.to_line();
    return *result;
  }
  [[nodiscard]] std::filesystem::path file(const results::RunResult& result,
                                           const std::string& name) const {
    return case_folder(folder_.path(), result.case_id) / name;
  }

  testing::ScratchFolder folder_;
};

TEST(GraphPlan, RunsRivalsOnTheSameGraphOneAfterTheOtherAndRepeatsBySeed) {
  Suite suite = suite_of({"graph-batch@odometry", "graph-incremental"}, {"walk-20-s1"});
  suite.backends = {"gauss-newton", "isam2"};
  suite.num_seeds = 2;
  suite.first_seed = 5;
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 8U);
  EXPECT_EQ(plan.cases[0].backend, "gauss-newton");
  EXPECT_EQ(plan.cases[1].backend, "isam2");
  EXPECT_EQ(plan.cases[2].system, "graph-incremental");
  EXPECT_EQ(plan.cases[3].system_seed, 5U);
  EXPECT_EQ(plan.cases[4].system_seed, 6U);
  for (const CaseSpec& spec : plan.cases) {
    EXPECT_EQ(spec.data_kind, DataKind::kGraph);
    EXPECT_FALSE(spec.data_seed.has_value());
    EXPECT_FALSE(spec.data_digest.empty());
    EXPECT_EQ(case_spec_from_json(to_json(spec), "spec").value(), spec);
  }
}

TEST(GraphPlan, SaysOnceWhoCannotTakeWhat) {
  Suite suite = suite_of({"karto", "graph-batch@file", "graph-batch@chordal"}, {"walk-20-s1"});
  suite.scenarios = {"paper-corridor"};
  suite.num_seeds = 2;
  const Plan plan = plan_of(suite);
  EXPECT_EQ(plan.cases.size(), 6U) << "karto on two worlds, two batches twice on the graph";
  ASSERT_EQ(plan.skipped.size(), 2U);
  EXPECT_EQ(plan.skipped[0],
            "graph-batch on paper-corridor: skipped: needs a pose graph, and this is a log");
  EXPECT_EQ(plan.skipped[1], "karto on walk-20-s1: skipped: needs a log, and this is a pose graph");
}

TEST(GraphPlan, GivesASystemTheBackEndsThatTheSuiteHasForIt) {
  Suite suite = suite_of({"graph-batch@file", "graph-incremental@each"}, {"walk-20-s1"});
  suite.backends = {"gauss-newton", "levenberg"};
  suite.backends_of = {{*parse_system_choice("graph-incremental@each"), {"isam2"}}};
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 3U);
  EXPECT_EQ(plan.cases[2].backend, "isam2");
}

TEST(GraphPlan, AsksNoBackEndThatForgetsForAllPosesAtOnce) {
  Suite suite = suite_of({"graph-batch@file", "graph-incremental@each"}, {"walk-20-s1"});
  suite.backends = {"fixed-lag", "isam2"};
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 3U);
  ASSERT_EQ(plan.skipped.size(), 1U);
  EXPECT_EQ(plan.skipped[0],
            "graph-batch@file with fixed-lag: skipped: asks for all poses at once, and fixed-lag "
            "forgets old ones");
}

TEST(GraphTask, StopsBackEndsOfOurOwnWhereTheOthersStop) {
  EXPECT_EQ(task_of(GraphIncrementalParams()).settings.min_relative_decrease,
            task_of(GraphBatchParams()).settings.min_relative_decrease);
  EXPECT_EQ(task_of(GraphIncrementalParams()).settings.max_iterations,
            task_of(GraphBatchParams()).settings.max_iterations);
}

TEST(GraphPlan, MakesARowOfABrokenGraphAndSkipsOneThatIsNotHere) {
  const testing::ScratchFolder folder;
  const Plan plan = plan_of(suite_of(
      {"graph-batch"}, {folder.write("broken.g2o", "VERTEX_SE2 0 zero 0 0\n").string(), "M3500"}));
  ASSERT_EQ(plan.cases.size(), 1U);
  EXPECT_EQ(plan.cases[0].data_kind, DataKind::kGraph);
  ASSERT_EQ(plan.skipped.size(), 1U);
  EXPECT_EQ(plan.skipped[0].rfind("M3500: skipped: ", 0), 0U);
}

TEST_F(GraphCase, OfABatchHasChi2AgainstTheBestAndTheErrorAgainstTheTruth) {
  const results::RunResult result = run(only_case("graph-batch@odometry", "gauss-newton"));
  EXPECT_EQ(result.status, CaseStatus::kOk) << result.status_message;
  EXPECT_EQ(result.data_kind, "graph");
  EXPECT_EQ(result.variables, 300);
  EXPECT_GT(*result.factors, 300);
  EXPECT_EQ(result.chi2_best_source, "own");
  EXPECT_NEAR(*result.chi2_gap_ratio, 0, 1e-6);
  EXPECT_GT(*result.chi2_initial, *result.chi2);
  EXPECT_FALSE(result.eliminated.has_value()) << "not counted is not none";
  EXPECT_EQ(result.true_poses, "truth");
  EXPECT_EQ(result.poses_matched, 300);
  // 300 m of a way whose odometry alone strays by metres.
  EXPECT_LT(*result.final_scores.position_rmse_m, 1);
  EXPECT_FALSE(result.online_scores.position_rmse_m.has_value());
  EXPECT_FALSE(result.step_p50_us.has_value());
  EXPECT_GT(*result.wall_s, *result.init_s);
  const auto solved = formats::read_pose_graph(file(result, "final.g2o"));
  ASSERT_TRUE(solved.has_value());
  EXPECT_EQ(solved->vertices.size(), 300U);
  EXPECT_FALSE(std::filesystem::exists(file(result, "updates.csv")));
  EXPECT_EQ(results::to_json(*results::read_result(file(result, "result.json"))),
            results::to_json(result));
}

TEST_F(GraphCase, OfAnIncrementalRunHasALinePerUpdateAndTheGapAtCheckpoints) {
  CaseSpec spec = only_case("graph-incremental", "isam2");
  spec.overrides = {{"num_checkpoints", "10"}};
  const results::RunResult result = run(spec);
  EXPECT_EQ(result.status, CaseStatus::kOk) << result.status_message;
  EXPECT_GT(*result.step_max_us, 0);
  EXPECT_GE(*result.step_max_us, *result.step_mean_us);
  EXPECT_GE(*result.run_gap_max_ratio, *result.run_gap_p50_ratio);
  EXPECT_TRUE(result.run_newest_gap_max_m.has_value());
  EXPECT_GT(*result.online_scores.position_rmse_m, 0);
  EXPECT_GT(*result.eliminated, 300);
  EXPECT_GT(*result.factor_nonzeros, 100 * 6);
  std::ifstream csv(file(result, "updates.csv"));
  std::string line;
  int num_lines = 0, num_checkpoints = 0;
  std::getline(csv, line);
  EXPECT_EQ(line,
            "update,newest_pose,poses,time_us,relinearised,eliminated,factor_nonzeros,chi2,"
            "chi2_optimum,newest_gap_m,newest_gap_rad");
  while (std::getline(csv, line)) {
    ++num_lines;
    num_checkpoints += line.ends_with(",,,") ? 0 : 1;
  }
  EXPECT_EQ(num_lines, 300);
  EXPECT_EQ(num_checkpoints, 10);
  const auto online = formats::read_pose_graph(file(result, "online.g2o"));
  ASSERT_TRUE(online.has_value());
  EXPECT_EQ(online->vertices.size(), 300U);
}

TEST_F(GraphCase, WithoutCheckpointsHasTheSameSolutionAndNoGap) {
  CaseSpec spec = only_case("graph-incremental@every-10", "isam2");
  const results::RunResult traced = run(spec);
  spec.overrides = {{"num_checkpoints", "0"}};
  const results::RunResult untraced = run(spec);
  EXPECT_EQ(*traced.chi2, *untraced.chi2);
  EXPECT_TRUE(traced.run_gap_max_ratio.has_value());
  EXPECT_FALSE(untraced.run_gap_max_ratio.has_value());
}

TEST_F(GraphCase, StartsFromNoiseOfItsSeedOnTheOptimum) {
  CaseSpec spec = only_case("graph-batch@near-0.05", "gauss-newton");
  const results::RunResult first = run(spec);
  EXPECT_EQ(first.status, CaseStatus::kOk);
  EXPECT_LT(*first.chi2_gap_ratio, 1e-6);
  EXPECT_GT(*first.chi2_initial, 100 * *first.chi2);
  EXPECT_EQ(*run(spec).chi2_initial, *first.chi2_initial);
  spec.system_seed += 1;
  EXPECT_NE(*run(spec).chi2_initial, *first.chi2_initial);
}

TEST_F(GraphCase, ThatEndsFarFromTheBestIsLost) {
  CaseSpec spec = only_case("graph-batch@odometry", "gauss-newton");
  spec.overrides = {{"max_iterations", "1"}};
  const results::RunResult stopped = run(spec);
  EXPECT_EQ(stopped.status, CaseStatus::kDiverged);
  EXPECT_EQ(stopped.status_message, "the limit of iterations came before convergence");
  EXPECT_TRUE(stopped.chi2_gap_ratio.has_value()) << "its error stays in every table";
}

TEST_F(GraphCase, WithFalseClosuresSaysHowManyWerePlantedAndWhatWasRejected) {
  const results::RunResult result =
      run(only_case("graph-batch@gnc-false-30", "gauss-newton", kWalk));
  EXPECT_EQ(result.status, CaseStatus::kOk) << result.status_message;
  // 32 closures of the walk's own: 14 false ones are 30 % of 46.
  EXPECT_EQ(result.false_closures, 14);
  EXPECT_EQ(result.rejected_closures, 14);
  EXPECT_EQ(result.rejection_precision, 1.0);
  EXPECT_EQ(result.rejection_recall, 1.0);
  EXPECT_EQ(result.parameters.at("robust"), "gnc");
  EXPECT_EQ(result.parameters.at("false_closures"), "0.3");
  // Of the true edges alone, against an optimum without false ones.
  EXPECT_NEAR(*result.chi2_gap_ratio, 0, 1e-6);
}

TEST_F(GraphCase, WithFalseClosuresIsLostWhereNothingIsDoneAgainstThem) {
  const results::RunResult result =
      run(only_case("graph-batch@none-false-30", "gauss-newton", kWalk));
  EXPECT_EQ(result.status, CaseStatus::kDiverged);
  EXPECT_EQ(result.status_message.rfind("lost: chi2 ", 0), 0U) << result.status_message;
  EXPECT_EQ(result.false_closures, 14);
  EXPECT_FALSE(result.rejected_closures.has_value()) << "nothing looked for them";
  EXPECT_FALSE(result.rejection_recall.has_value());
  EXPECT_GT(*result.chi2_gap_ratio, 1) << "its error stays in every table";
}

TEST_F(GraphCase, WithoutFalseClosuresHasNoPrecisionOrRecall) {
  const results::RunResult none = run(only_case("graph-batch@none-false-0", "gauss-newton", kWalk));
  EXPECT_FALSE(none.false_closures.has_value());
  const results::RunResult gnc = run(only_case("graph-batch@gnc-false-0", "gauss-newton", kWalk));
  EXPECT_EQ(gnc.false_closures, 0);
  EXPECT_EQ(gnc.rejected_closures, 0);
  EXPECT_FALSE(gnc.rejection_precision.has_value());
  EXPECT_FALSE(gnc.rejection_recall.has_value());
}

TEST_F(GraphCase, PlantsTheSameFalseClosuresForTheSameSeedAlone) {
  CaseSpec spec = only_case("graph-batch@none-false-30", "gauss-newton", kWalk);
  const double chi2 = *run(spec).chi2;
  EXPECT_EQ(*run(spec).chi2, chi2);
  spec.system_seed += 1;
  EXPECT_NE(*run(spec).chi2, chi2);
}

// One case with what a suite sets by hand for its back-end.
CaseSpec case_with(const ParamValues& of_gauss_newton) {
  Suite suite = suite_of({"graph-batch@odometry"}, {kWalk});
  suite.backends = {"gauss-newton"};
  suite.overrides["gauss-newton"] = of_gauss_newton;
  return plan_of(suite).cases.at(0);
}

TEST_F(GraphCase, HasTheBackEndThatWasSetByHand) {
  const results::RunResult shipped = run(case_with({}));
  const results::RunResult stopped = run(case_with({{"max_iterations", "1"}}));
  EXPECT_EQ(shipped.status, CaseStatus::kOk);
  EXPECT_EQ(stopped.status, CaseStatus::kDiverged) << "the task's limit is 100";
  EXPECT_EQ(stopped.status_message, "the limit of iterations came before convergence");
  EXPECT_EQ(stopped.iterations, 1);
  EXPECT_EQ(stopped.overrides->at("gauss-newton.max_iterations"), "1");
  EXPECT_NE(stopped.parameters_hash, shipped.parameters_hash) << "never pooled";
}

TEST_F(GraphCase, WithTheOtherFactorisationEndsAtTheSameOptimum) {
  const results::RunResult shipped = run(case_with({}));
  const results::RunResult cholmod = run(case_with({{"linear", "cholmod"}}));
  EXPECT_EQ(cholmod.status, CaseStatus::kOk);
  EXPECT_NEAR(*cholmod.chi2 / *shipped.chi2, 1, 1e-9);
  EXPECT_NE(*cholmod.chi2, *shipped.chi2) << "rounded alike: not another factorisation";
  EXPECT_NE(cholmod.parameters_hash, shipped.parameters_hash);
}

TEST_F(GraphCase, IsRefusedWhereItsBackEndHasNoSuchParameter) {
  CaseSpec spec = case_with({});
  spec.overrides = {{"gauss-newton.liner", "cholmod"}};
  const auto refused = run_case(spec, {}, folder_.path(), 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().error.to_line().find("linear"), std::string::npos)
      << refused.error().error.to_line();
}

TEST_F(GraphCase, OfASystemThatNeedsALogIsRefusedAndTheOtherWayRound) {
  CaseSpec spec = only_case("graph-batch", "gauss-newton");
  spec.system = "karto";
  spec.profile = "as-shipped";
  EXPECT_FALSE(run_case(spec, {}, folder_.path(), 1).has_value());
  spec = only_case("graph-batch", "gauss-newton");
  spec.data_kind = DataKind::kSimulated;
  spec.data_source = "paper-corridor";
  spec.data_seed = 1;
  EXPECT_FALSE(run_case(spec, {}, folder_.path(), 1).has_value());
}

TEST(GraphSystems, RefuseAStartThatIsNone) {
  const SystemInfo batch = *find_system("graph-batch");
  EXPECT_TRUE(batch.resolve("file", {{"start", "chordal"}}).has_value());
  EXPECT_FALSE(batch.resolve("file", {{"start", "anywhere"}}).has_value());
  EXPECT_FALSE(batch.resolve("chordal", {{"start_heading_sigma_rad", "0.1"}}).has_value());
}

}  // namespace
}  // namespace corridor::runner
