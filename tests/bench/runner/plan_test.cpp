#include "bench/runner/plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "datasets/formats/log_io.hpp"
#include "tests/bench/runner/plans.hpp"
#include "tests/support/room_drive.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

using testing::plan_of;
using testing::suite_of;

TEST(Plan, RunsRivalsOnTheSameWorldOneAfterTheOther) {
  Suite suite = suite_of({"karto", "gmapping"});
  suite.scenarios = {"paper-corridor"};
  suite.num_seeds = 2;
  suite.first_seed = 5;
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 4U);
  EXPECT_EQ(plan.cases[0].system, "karto");
  EXPECT_EQ(plan.cases[1].system, "gmapping");
  EXPECT_EQ(plan.cases[1].data_seed, 5U);
  EXPECT_EQ(plan.cases[2].data_seed, 6U);
  EXPECT_EQ(plan.cases[2].system_seed, 6U);
  EXPECT_EQ(plan.cases[0].backend, "levenberg");
  EXPECT_FALSE(plan.cases[1].backend.has_value());
}

TEST(Plan, CrossesBackEndsWithTheSystemsThatTakeOne) {
  Suite suite = suite_of({"karto", "gmapping"});
  suite.scenarios = {"paper-corridor"};
  suite.backends = {"gauss-newton", "levenberg"};
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 3U);
  std::set<std::string> ids;
  for (const CaseSpec& spec : plan.cases) ids.insert(case_id(spec));
  EXPECT_EQ(ids.size(), plan.cases.size());
}

TEST(Plan, HandsOverridesToTheirSystemOnly) {
  Suite suite = suite_of({"karto", "gmapping"});
  suite.scenarios = {"paper-corridor"};
  suite.overrides["gmapping"] = {{"num_particles", "7"}};
  const Plan plan = plan_of(suite);
  EXPECT_TRUE(plan.cases[0].overrides.empty());
  EXPECT_EQ(plan.cases[1].overrides.at("num_particles"), "7");
}

TEST(Plan, SaysWhatItSkips) {
  Suite suite = suite_of({"karto"});
  suite.datasets = {"intel"};
  const Plan plan = plan_of(suite);
  EXPECT_TRUE(plan.cases.empty());
  ASSERT_EQ(plan.skipped.size(), 1U);
  EXPECT_EQ(plan.skipped[0].rfind("intel: skipped: ", 0), 0U) << plan.skipped[0];
}

TEST(Plan, RefusesDataThatWereNamedAndCannotBeLoaded) {
  Suite suite = suite_of({"karto"});
  suite.datasets = {"intel"};
  EXPECT_FALSE(make_plan(suite, {}, {.must_load_data = true}).has_value());
  suite.datasets.clear();
  suite.scenarios = {"no-such-scenario"};
  EXPECT_FALSE(make_plan(suite, {}).has_value());
}

TEST(Plan, MakesARowOfBrokenDataInASuite) {
  const testing::ScratchFolder folder;
  Suite suite = suite_of({"karto"});
  suite.datasets = {folder.write("broken.clf", "FLASER garbage\n").string()};
  const Plan plan = plan_of(suite);
  EXPECT_EQ(plan.cases.size(), 1U);
  EXPECT_TRUE(plan.skipped.empty());
}

// A CARMEN log of two scans of eight beams.
constexpr const char* kTinyLog =
    "ODOM 0 0 0 0.2 0 0 1.0 host 1.0\n"
    "FLASER 8 1 1 1 1 1 1 1 1 0 0 0 0 0 0 1.0 host 1.0\n"
    "ODOM 0.1 0 0 0.2 0 0 1.1 host 1.1\n"
    "FLASER 8 1 1 1 1 1 1 1 1 0.1 0 0 0.1 0 0 1.1 host 1.1\n";

// Not a case that passes with every pose at the origin.
TEST(Plan, SkipsSystemsThatNeedASensorWhichTheLogDoesNotHave) {
  SensorLog log = testing::room_log({.num_scans = 2});
  std::erase_if(log.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  const testing::ScratchFolder folder;
  ASSERT_TRUE(formats::write_log(log, folder / "no-wheels.bag"));
  Suite suite = suite_of({"dead-reckoning", "gmapping", "karto", "mrpt-icp"});
  suite.datasets = {(folder / "no-wheels.bag").string()};
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 1U);
  EXPECT_EQ(plan.cases[0].system, "mrpt-icp");
  ASSERT_EQ(plan.skipped.size(), 3U);
  EXPECT_EQ(plan.skipped[0],
            "dead-reckoning on no-wheels: skipped: needs wheels, and the log has none");
}

TEST(Plan, TellsLogsOfTheSameFileNameApart) {
  const testing::ScratchFolder folder;
  Suite suite = suite_of({"karto"});
  suite.datasets = {folder.write("monday/run.log", kTinyLog).string(),
                    folder.write("tuesday/run.log", kTinyLog).string(),
                    (folder / "monday/../tuesday/run.log").string()};
  const Plan plan = plan_of(suite);
  ASSERT_EQ(plan.cases.size(), 2U) << "one file, spelled in two ways, counts once";
  EXPECT_EQ(plan.cases[0].dataset, "monday/run");
  EXPECT_EQ(plan.cases[1].dataset, "tuesday/run");
}

TEST(Plan, RefusesAFolderAsALog) {
  const testing::ScratchFolder folder;
  Suite suite = suite_of({"karto"});
  suite.datasets = {folder.path().string()};
  const auto refused = make_plan(suite, {}, {.must_load_data = true});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what, "this is a folder");
}

TEST(Plan, RunsRecordedDataOncePerSeedOnlyWithSystemsThatDrawRandomNumbers) {
  const testing::ScratchFolder folder;
  Suite suite = suite_of({"karto", "gmapping"});
  suite.datasets = {folder.write("tiny.clf", kTinyLog).string()};
  suite.num_seeds = 3;
  const Plan plan = plan_of(suite);
  int num_karto = 0;
  for (const CaseSpec& spec : plan.cases) {
    num_karto += spec.system == "karto" ? 1 : 0;
    EXPECT_EQ(spec.dataset, "tiny");
    EXPECT_FALSE(spec.data_seed.has_value());
    EXPECT_FALSE(spec.data_digest.empty());
  }
  EXPECT_EQ(num_karto, 1);
  EXPECT_EQ(plan.cases.size(), 4U);
}

}  // namespace
}  // namespace corridor::runner
