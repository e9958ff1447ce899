// Which cases are one series, and what a series is called.
#include <gtest/gtest.h>

#include <set>

#include "reports/metrics.hpp"
#include "reports/tables/summary.hpp"
#include "tests/reports/synthetic_run.hpp"

namespace corridor::reports {
namespace {

using results::RunResult;
using testing::make_cases;

RunResult karto_result(std::uint64_t seed = 1) {
  return testing::synthetic_result(testing::paper_like_run(), {"karto", 0.06}, seed);
}

// Karto once more with one parameter changed.
RunResult changed_result(const std::string& value, std::uint64_t seed = 1) {
  RunResult result = karto_result(seed);
  result.parameters["num_particles"] = value;
  result.parameters_hash = "hash-of-" + value;
  result.case_id += "-" + value;
  return result;
}

std::vector<std::string> labels(const Cases& cases) {
  std::vector<std::string> texts;
  for (const Series& series : cases.series()) texts.push_back(cases.label(series));
  return texts;
}

TEST(Series, OfOneProfileWithOtherParametersAreNotPooled) {
  const Cases cases = make_cases({changed_result("30"), changed_result("99")});
  ASSERT_EQ(cases.series().size(), 2U);
  for (const Series& series : cases.series()) {
    EXPECT_EQ(tables::world_values(cases, "synthetic-corridor", series, position_error()).size(),
              1U);
    EXPECT_EQ(cases.of("synthetic-corridor", series).size(), 1U);
  }
}

TEST(Series, OfAnotherRevisionOfTheCodeAreNotPooled) {
  RunResult newer = karto_result();
  newer.git_revision = "1111111aaaaa+dirty";
  EXPECT_EQ(labels(make_cases({karto_result(), newer})),
            (std::vector<std::string>{"karto (at 0000000)", "karto (at 1111111+dirty)"}));
}

TEST(Series, StaysOneOverWorldsAndSystemSeeds) {
  RunResult other_seed = karto_result();
  other_seed.system_seed = 7;
  EXPECT_EQ(labels(make_cases({karto_result(1), karto_result(2), other_seed})),
            std::vector<std::string>{"karto"});
}

TEST(DataSets, OfOneNameButOtherContentAreNotPooled) {
  RunResult first = karto_result(1);
  first.data_digest = "aaaaaaaa1";
  RunResult second = karto_result(1);
  second.data_digest = "bbbbbbbb2";
  const Cases cases = make_cases({first, second});
  EXPECT_EQ(cases.datasets(), (std::vector<std::string>{"synthetic-corridor (#aaaaaa)",
                                                        "synthetic-corridor (#bbbbbb)"}));
  EXPECT_EQ(cases.all()[0].dataset_given, "synthetic-corridor");
}

TEST(DataSets, WhoseContentOneFailedCaseNeverSawStayOne) {
  RunResult known = karto_result(1);
  known.data_digest = "aaaaaaaa1";
  const Cases cases = make_cases({known, karto_result(2)});
  EXPECT_EQ(cases.datasets(), std::vector<std::string>{"synthetic-corridor"});
}

TEST(Cases, OfOneExperimentStandOnceAndTheNewestDoes) {
  RunResult newer = karto_result();
  newer.final_scores.position_rmse_m = 7;
  const Cases cases = make_cases({karto_result(), newer, karto_result(2)});
  ASSERT_EQ(cases.all().size(), 2U);
  EXPECT_EQ(cases.num_set_aside(), 1U);
  EXPECT_EQ(cases.all()[0].result.final_scores.position_rmse_m, 7);
}

TEST(SeriesLabel, NamesTheParameterThatDiffers) {
  EXPECT_EQ(labels(make_cases({changed_result("30"), changed_result("99")})),
            (std::vector<std::string>{"karto (num_particles=30)", "karto (num_particles=99)"}));
}

TEST(SeriesLabel, IsAHashWhereManyParametersDiffer) {
  RunResult other = karto_result();
  other.parameters_hash = "fedcba987654";
  other.parameters = {{"a", "1"}, {"b", "2"}, {"c", "3"}};
  EXPECT_EQ(labels(make_cases({karto_result(), other})),
            (std::vector<std::string>{"karto (#0123ab)", "karto (#fedcba)"}));
}

TEST(SeriesLabel, SaysWhichSeriesLacksAParameter) {
  RunResult other = karto_result();
  other.parameters_hash = "fedcba987654";
  other.parameters.erase("num_particles");
  EXPECT_EQ(labels(make_cases({karto_result(), other})),
            (std::vector<std::string>{"karto (num_particles=30)", "karto (num_particles=none)"}));
}

TEST(SeriesLabel, IsNeverTheSameForTwoSeries) {
  std::vector<RunResult> results;
  for (const char* revision : {"1234567aaa", "1234567bbb"}) {
    for (const char* hash : {"0000001", "0000002"}) {
      results.push_back(karto_result());
      results.back().git_revision = revision;
      results.back().parameters_hash = hash;  // with the same parameters: only the hash differs
    }
  }
  const std::vector<std::string> all = labels(make_cases(results));
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 4U);
}

TEST(SeriesOrder, PutsWhatASystemShipsWithBeforeItsOtherProfiles) {
  RunResult corrected = karto_result();
  corrected.profile = "corrected";
  RunResult shipped = karto_result();
  shipped.profile = "as-shipped";
  EXPECT_EQ(labels(make_cases({corrected, shipped})),
            (std::vector<std::string>{"karto@as-shipped", "karto@corrected"}));
}

}  // namespace
}  // namespace corridor::reports
