// Graphs that systems make as data: their names, their plans, their cases.
#include "bench/runner/graph_of.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "bench/runner/case_files.hpp"
#include "bench/runner/data_kind.hpp"
#include "bench/runner/plan.hpp"
#include "bench/runner/record_graph.hpp"
#include "bench/runner/run_case.hpp"
#include "datasets/formats/log_io.hpp"
#include "tests/bench/runner/plans.hpp"
#include "tests/support/room_drive.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

using results::CaseStatus;
using testing::plan_of;
using testing::suite_of;

// A short way, with IMU and wheels.
constexpr const char* kShortWorld = "base = \"paper-corridor\"\n[world]\na_m = 8\nb_m = 8\n";

class GraphOfCase : public ::testing::Test {
 protected:
  void SetUp() override {
    name_ = "graph-of:fusion:" + folder_.write("short.toml", kShortWorld).string() + ":7";
  }

  results::RunResult run(const std::string& system, const std::string& backend) {
    Suite suite = suite_of({system}, {name_});
    suite.backends = {backend};
    const auto result =
        run_case(plan_of(suite).cases.at(0), catalog::DataDirs{}, folder_.path(), 1);
    EXPECT_TRUE(result.has_value()) << result.error().error.to_line();
    return *result;
  }

  testing::ScratchFolder folder_;
  std::string name_;
};

TEST(GraphOf, NamesASystemItsDataAndOfAScenarioTheSeed) {
  const auto simulated = graph_of_from("graph-of:karto@corrected:paper-corridor:1001", {});
  ASSERT_TRUE(simulated.has_value()) << simulated.error().to_line();
  EXPECT_EQ(*simulated,
            (GraphOf{{"karto", "corrected"}, DataKind::kSimulated, "paper-corridor", 1001}));
  EXPECT_EQ(to_text(*simulated), "graph-of:karto@corrected:paper-corridor:1001");
  const catalog::Catalog known = *catalog::known_datasets({});
  const auto recorded = graph_of_from("graph-of:fusion:intel", known);
  ASSERT_TRUE(recorded.has_value()) << recorded.error().to_line();
  EXPECT_EQ(*recorded,
            (GraphOf{{"fusion", "default"}, DataKind::kRecorded, "intel", std::nullopt}));
  EXPECT_EQ(to_text(*recorded), "graph-of:fusion@default:intel");
  EXPECT_EQ(*kind_of_data("graph-of:fusion:intel", known), DataKind::kGraph);
}

TEST(GraphOf, RefusesABadSpellingInOneLineThatSaysWhatIsWrong) {
  const catalog::Catalog known = *catalog::known_datasets({});
  const std::map<std::string, std::string> wrong = {
      {"graph-of:", "names no data"},
      {"graph-of:fusion", "names no data"},
      {"graph-of:fusion:", "names no data"},
      {"graph-of::intel", "unknown system \"\""},
      {"graph-of:nobody:intel", "unknown system \"nobody\""},
      {"graph-of:fusion@fast:intel", "unknown profile \"fast\""},
      {"graph-of:gmapping:intel", "system gmapping makes no graph"},
      {"graph-of:graph-batch:intel", "system graph-batch makes no graph"},
      {"graph-of:fusion:nowhere", "'nowhere' is neither"},
      {"graph-of:fusion:M3500", "M3500 is a graph"},
      {"graph-of:fusion:graph-of:fusion:intel", "is a graph"},
      {"graph-of:fusion:intel:3", "intel is recorded and has no seed"},
      {"graph-of:fusion:paper-corridor", "scenario paper-corridor without a seed"},
      {"graph-of:fusion:paper-corridor:", "'paper-corridor:' is neither"},
      {"graph-of:fusion:paper-corridor:-1", "'paper-corridor:-1' is neither"},
      {"graph-of:fusion:paper-corridor:99999999999999999999", "is too large"}};
  for (const auto& [name, reason] : wrong) {
    const auto refused = kind_of_data(name, known);
    ASSERT_FALSE(refused.has_value()) << name;
    const std::string line = refused.error().to_line();
    EXPECT_NE(line.find(reason), std::string::npos) << line;
    EXPECT_NE(line.find(name), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_FALSE(make_plan(suite_of({"graph-batch"}, {name}), {}).has_value())
        << name << ": a suite says it before anything runs";
  }
}

TEST(GraphOf, IsANameThatNoDataSetMayHave) {
  catalog::Catalog known;
  known.entries.emplace_back().name = "graph-of:fusion:intel";
  EXPECT_FALSE(check_one_meaning("graph-of:fusion:intel", known).has_value());
  EXPECT_TRUE(check_one_meaning("graph-of:fusion:intel", {}).has_value());
}

TEST(GraphOf, IsPlannedForWhatCanSolveItAndTheRestIsSkippedWithItsReason) {
  Suite suite = suite_of(
      {"graph-batch@file", "graph-batch@odometry", "graph-batch@near-0.1", "graph-incremental@each",
       "graph-incremental@every-10", "graph-incremental@calls", "karto"},
      {"graph-of:fusion:paper-corridor:5", "walk-20-s1"});
  suite.backends = {"gauss-newton", "isam2"};
  suite.num_seeds = 2;
  const Plan plan = plan_of(suite);
  std::map<std::string, int> num_cases;
  for (const CaseSpec& spec : plan.cases) {
    EXPECT_EQ(spec.data_kind, DataKind::kGraph);
    EXPECT_EQ(case_spec_from_json(to_json(spec), "spec").value(), spec);
    if (spec.dataset == "walk-20-s1") continue;
    EXPECT_EQ(spec.dataset, "graph-of:fusion@default:paper-corridor:5");
    EXPECT_FALSE(spec.data_seed.has_value()) << "it is in the name";
    EXPECT_FALSE(spec.data_digest.empty());
    EXPECT_EQ(case_id(spec).find_first_of(":/"), std::string::npos) << "names a folder";
    ++num_cases[spec.system + "@" + spec.profile];
  }
  const std::map<std::string, int> expected = {{"graph-batch@file", 4},
                                               {"graph-incremental@calls", 4}};
  EXPECT_EQ(num_cases, expected);
  const std::string on = " on graph-of:fusion@default:paper-corridor:5: skipped: ";
  const std::string moved = "starts elsewhere, and this graph has the values that its system gave";
  const std::string by_pose = "goes pose by pose, and this graph has calls: see profile calls";
  EXPECT_EQ(
      plan.skipped,
      (std::vector<std::string>{
          "graph-batch@odometry" + on + moved, "graph-batch@near-0.1" + on + moved,
          "graph-incremental@each" + on + by_pose, "graph-incremental@every-10" + on + by_pose,
          "karto" + on + "needs a log, and this is a pose graph",
          "graph-incremental@calls on walk-20-s1: skipped: replays a system's calls, and "
          "this is a pose graph",
          "karto on walk-20-s1: skipped: needs a log, and this is a pose graph"}));
}

TEST(GraphOf, IsSkippedWhereItsSystemLacksASensorOrItsDataAreNotHere) {
  SensorLog log = testing::room_log({.num_scans = 2});
  std::erase_if(log.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  const testing::ScratchFolder folder;
  const std::string path = (folder / "no-wheels.bag").string();
  ASSERT_TRUE(formats::write_log(log, path));
  const Plan plan =
      plan_of(suite_of({"graph-batch"}, {"graph-of:karto:" + path, "graph-of:karto:intel"}));
  EXPECT_TRUE(plan.cases.empty());
  ASSERT_EQ(plan.skipped.size(), 2U);
  EXPECT_NE(plan.skipped[0].find("karto needs wheels"), std::string::npos) << plan.skipped[0];
  EXPECT_EQ(plan.skipped[1].rfind("graph-of:karto:intel: skipped: ", 0), 0U) << plan.skipped[1];
}

TEST_F(GraphOfCase, HasInertialFactorsOfFusion) {
  const auto recording = record_graph(*graph_of_from(name_, {}), {});
  ASSERT_TRUE(recording.has_value()) << recording.error().to_line();
  const auto kinds = solve::kinds_of(recording->recording.factors());
  for (const char* kind : {"imu_motion", "bias_walk", "wheel_motion", "relative_pose"}) {
    EXPECT_TRUE(kinds.contains(kind)) << kind;
  }
}

TEST_F(GraphOfCase, IsSolvedAtOnceToOneChi2ByEveryBackEnd) {
  for (const char* backend : {"gauss-newton", "levenberg", "isam2", "ceres"}) {
    const results::RunResult result = run("graph-batch@file", backend);
    EXPECT_EQ(result.status, CaseStatus::kOk) << backend << ": " << result.status_message;
    EXPECT_EQ(result.chi2_best_source, "own");
    EXPECT_NEAR(*result.chi2, *result.chi2_best, 1e-6 * *result.chi2_best) << backend;
    EXPECT_GT(*result.chi2_initial, *result.chi2) << backend;
    EXPECT_EQ(result.poses_matched, result.poses_expected);
    EXPECT_LT(*result.poses_expected, *result.variables) << "others are velocities and biases";
  }
}

TEST_F(GraphOfCase, CallByCallHasEveryUpdateItsTimeAndTheGapAlongTheRun) {
  const results::RunResult result = run("graph-incremental@calls", "isam2");
  EXPECT_EQ(result.status, CaseStatus::kOk) << result.status_message;
  EXPECT_LT(std::abs(*result.chi2_gap_ratio), 1e-3);
  EXPECT_GT(*result.step_p50_us, 0);
  EXPECT_GT(*result.relinearised, 0);
  EXPECT_GT(*result.eliminated, 0);
  EXPECT_TRUE(result.run_gap_max_ratio.has_value());
  const auto folder = case_folder(folder_.path(), result.case_id);
  std::ifstream updates(folder / "updates.csv");
  std::string line;
  std::int64_t num_rows = -1;  // the header
  while (std::getline(updates, line)) ++num_rows;
  EXPECT_GE(num_rows, *result.poses_expected) << "one for every key scan, more for closures";
  EXPECT_TRUE(std::filesystem::exists(folder / "final.g2o"));
}

TEST_F(GraphOfCase, IsRefusedWhereTheSystemNeverHasItSolved) {
  const std::string path = (folder_ / "short.toml").string();
  const auto refused = record_graph(*graph_of_from("graph-of:karto:" + path + ":7", {}), {});
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("never has its graph solved"), std::string::npos);
}

TEST_F(GraphOfCase, IsRefusedByATaskThatItCannotHave) {
  Suite suite = suite_of({"graph-batch@file"}, {name_});
  CaseSpec spec = plan_of(suite).cases.at(0);
  spec.overrides = {{"robust", "huber"}};
  const auto refused = run_case(spec, catalog::DataDirs{}, folder_.path(), 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_FALSE(refused.error().is_of_output);
  EXPECT_NE(refused.error().error.to_line().find("treats closures as such"), std::string::npos);
  suite.overrides["graph-batch"] = spec.overrides;
  EXPECT_EQ(plan_of(suite).skipped.size(), 1U) << "and not planned";
}

}  // namespace
}  // namespace corridor::runner
