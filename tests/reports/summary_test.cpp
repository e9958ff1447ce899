// One value per world, medians with their counts, and who is clearly best: on hand-made results.
#include "reports/tables/summary.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "reports/metrics.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::CaseStatus;
using results::RunResult;

RunResult make_result(const std::string& system, std::uint64_t data_seed,
                      std::optional<double> position_m, std::uint64_t system_seed = 1) {
  RunResult result;
  result.case_id = system + std::to_string(data_seed) + "-" + std::to_string(system_seed);
  result.system = system;
  result.dataset = "d";
  result.data_seed = data_seed;
  result.system_seed = system_seed;
  result.status = CaseStatus::kOk;
  result.final_scores.position_rmse_m = position_m;
  return result;
}

Cases make_cases(const std::vector<RunResult>& results) {
  std::vector<Case> cases;
  for (const RunResult& result : results) cases.push_back({result, {}});
  return Cases(std::move(cases), {}, {});
}

const Series kA{"a", "", ""};

TEST(WorldValues, TakeTheMedianOfTheSystemSeedsOfAWorld) {
  const Cases cases = make_cases({make_result("a", 1, 3.0, 1), make_result("a", 1, 1.0, 2),
                                  make_result("a", 1, 2.0, 3), make_result("a", 2, 7.0)});
  const WorldValues values = world_values(cases, "d", kA, reports::position_error());
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values.begin()->second, 2.0);
  EXPECT_EQ(values.rbegin()->second, 7.0);
}

TEST(WorldValues, LeaveOutPartialRunsAndValuesThatAreNotFinite) {
  RunResult partial = make_result("a", 1, 0.001);
  partial.status = CaseStatus::kPartial;
  const Cases cases = make_cases({partial, make_result("a", 2, std::nullopt),
                                  make_result("a", 3, std::numeric_limits<double>::infinity()),
                                  make_result("a", 4, 5.0)});
  EXPECT_EQ(world_values(cases, "d", kA, reports::position_error()).size(), 1U);
  EXPECT_EQ(num_worlds(cases, "d", kA), 4);
  EXPECT_EQ(num_ok_worlds(cases, "d", kA), 3);
}

TEST(WorldValues, OfRecordedDataAreThoseOfTheSystemSeeds) {
  RunResult first = make_result("a", 0, 1.0, 1);
  RunResult second = make_result("a", 0, 2.0, 2);
  first.data_seed.reset();
  second.data_seed.reset();
  EXPECT_EQ(num_worlds(make_cases({first, second}), "d", kA), 2);
}

TEST(Summarise, GivesMedianCountsAndAnIntervalInsideTheRange) {
  std::vector<RunResult> results;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    results.push_back(make_result("a", seed, 0.1 * static_cast<double>(seed)));
  }
  results.push_back(make_result("a", 10, std::nullopt));
  const Cell cell = summarise(make_cases(results), "d", kA, reports::position_error());
  const auto& estimate = std::get<Estimate>(cell);
  EXPECT_DOUBLE_EQ(estimate.median, 0.5);
  EXPECT_EQ(estimate.n, 9);
  EXPECT_EQ(estimate.of, 10);
  ASSERT_TRUE(estimate.low && estimate.high);
  EXPECT_GE(*estimate.low, 0.1);
  EXPECT_LT(*estimate.low, 0.5);
  EXPECT_GT(*estimate.high, 0.5);
  EXPECT_LE(*estimate.high, 0.9);
}

TEST(Summarise, ShowsNoIntervalOfFiveWorlds) {
  std::vector<RunResult> results;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) results.push_back(make_result("a", seed, 1.0));
  const Cell cell = summarise(make_cases(results), "d", kA, reports::position_error());
  EXPECT_FALSE(std::get<Estimate>(cell).low.has_value());
}

TEST(Summarise, SaysWhyThereIsNoValue) {
  const Cases cases = make_cases({make_result("a", 1, std::nullopt)});
  const Metric metric = reports::position_error();
  EXPECT_EQ(std::get<Missing>(summarise(cases, "d", kA, metric, "not measurable")).reason,
            "not measurable (0/1)");
  EXPECT_EQ(std::get<Missing>(summarise(cases, "d", {"b", "", ""}, metric)).reason, "not run");
}

WorldValues worlds(const std::vector<double>& values) {
  WorldValues by_world;
  std::uint64_t seed = 1;
  for (const double value : values) by_world[{"d", seed++, 0}] = value;
  return by_world;
}

TEST(CompareWorlds, GivesTheFactorOfAHandMadePair) {
  const auto ratio = compare_worlds(worlds({1, 2, 3, 4, 5, 6}), worlds({0.5, 1, 1.5, 2, 2.5, 3}));
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->value, 0.5, 1e-12);
  EXPECT_LT(ratio->high, 1);
  EXPECT_FALSE(compare_worlds(worlds({1, 2}), worlds({1, 2})));
}

TEST(ClearlySmallest, NeedsALeadInTheWorldsAndNotOnlyInTheMedian) {
  const WorldValues good = worlds({1, 1, 1, 1, 1, 1, 1, 1});
  const WorldValues bad = worlds({2, 3, 2, 3, 2, 3, 2, 3});
  const WorldValues mixed = worlds({0.5, 2, 0.5, 2, 0.5, 2, 0.5, 2});
  EXPECT_EQ(clearly_smallest({bad, good}), 1U);
  EXPECT_EQ(clearly_smallest({good, mixed, bad}), std::nullopt);
  EXPECT_EQ(clearly_smallest({good}), std::nullopt);
  EXPECT_EQ(clearly_smallest({good, good}), std::nullopt);
}

TEST(ClearlySmallest, IsNotWonByFailingInTheHardWorlds) {
  const WorldValues survivor = worlds({1, 1, 1, 1, 1, 1});
  const WorldValues complete = worlds({2, 2, 2, 2, 2, 2, 9, 9});
  EXPECT_EQ(clearly_smallest({survivor, complete}), std::nullopt);
  EXPECT_EQ(clearly_smallest({survivor, {}}), std::nullopt);
}

TEST(Cases, LabelsNameProfileAndBackEndOnlyWhereTheyDiffer) {
  RunResult plain = make_result("fusion", 1, 1.0);
  plain.profile = "default";
  RunResult shipped = make_result("karto", 1, 1.0);
  shipped.profile = "as-shipped";
  RunResult tuned = shipped;
  tuned.profile = "tuned";
  const Cases cases = make_cases({plain, shipped, tuned});
  EXPECT_EQ(cases.label(reports::series_of(plain)), "fusion");
  EXPECT_EQ(cases.label(reports::series_of(tuned)), "karto@tuned");
  ASSERT_EQ(cases.series().size(), 3U);
  EXPECT_EQ(cases.series().back().system, "fusion");
}

}  // namespace
}  // namespace corridor::tables
