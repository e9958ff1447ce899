// What the tables say of uncertainty and sensor health.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/figures/report_figures.hpp"
#include "reports/tables/report_tables.hpp"
#include "tests/reports/synthetic_run.hpp"

namespace corridor::reports {
namespace {

using tables::Missing;
using tables::Number;
using tables::Table;
using ::testing::HasSubstr;
using ::testing::Not;

// Eight worlds in which NEES of the last pose is the same.
Table consistency_of(double nees_last) {
  auto results = testing::synthetic_results(testing::run_of({{"fusion", 0.01}}));
  for (results::RunResult& result : results) {
    result.nees_last = nees_last;
    result.nees_mean = 2;
    result.nees_dof = 3;
  }
  return tables::consistency_table(testing::make_cases(results));
}

// Chi-square of 24 degrees of freedom: 12.401 and 39.364 at 2.5 and 97.5 %.
TEST(ConsistencyTable, HoldsTheMeanAgainstTheChiSquareInterval) {
  const Table table = consistency_of(4.9);
  ASSERT_EQ(table.rows.size(), 1u);
  const auto& row = table.rows.front();
  EXPECT_NEAR(std::get<Number>(row[3]).value, 4.9, 1e-12);
  EXPECT_NEAR(std::get<Number>(row[4]).value, 12.401 / 8, 1e-3);
  EXPECT_NEAR(std::get<Number>(row[5]).value, 39.364 / 8, 1e-3);
  EXPECT_EQ(std::get<std::string>(row[6]), "consistent");
  EXPECT_EQ(std::get<std::string>(consistency_of(4.95).rows.front()[6]), "too sure of itself");
  EXPECT_EQ(std::get<std::string>(consistency_of(1.5).rows.front()[6]), "too careful");
}

TEST(ConsistencyTable, HasNoRowForSystemsThatStateNoCovariance) {
  const auto results = testing::synthetic_results(testing::run_of({{"gmapping", 0.01}}));
  EXPECT_TRUE(tables::consistency_table(testing::make_cases(results)).rows.empty());
}

TEST(DetectionTable, TellsWhatWasNotThereToBeNoticedFromWhatWasNotNoticed) {
  auto results = testing::synthetic_results(testing::run_of({{"fusion", 0.01}, {"karto", 0.1}}));
  for (results::RunResult& result : results) {
    if (result.system == "fusion") result.degeneracy_recall = 0;
  }
  const Table table = tables::detection_table(testing::make_cases(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Missing>(table.rows.front()[3]));
  EXPECT_EQ(std::get<tables::Estimate>(table.rows.front()[6]).median, 0);
}

TEST(AccuracyBounds, StandBesideTheErrorsInTableAndFigure) {
  auto results = testing::synthetic_results(testing::run_of({{"fusion", 0.01}, {"karto", 0.1}}));
  const Cases without = testing::make_cases(results);
  EXPECT_EQ(tables::trajectory_error_table(without).rows.size(), 2u);
  for (results::RunResult& result : results) {
    result.bound_position_rmse_m = 0.005;
    result.bound_angle_rmse_deg = 0.02;
  }
  const Cases cases = testing::make_cases(results);
  const Table table = tables::trajectory_error_table(cases);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(std::get<std::string>(table.rows[2][1]), "Cramer-Rao bound");
  EXPECT_EQ(std::get<tables::Estimate>(table.rows[2][2]).median, 0.005);
  EXPECT_EQ(std::get<tables::Estimate>(table.rows[2][2]).n, 8);
  const std::string dataset = cases.datasets().front();
  EXPECT_THAT(figures::error_figure(cases, dataset)->svg.element(), HasSubstr("class=\"limit\""));
  EXPECT_THAT(figures::error_figure(without, dataset)->svg.element(),
              Not(HasSubstr("class=\"limit\"")));
}

}  // namespace
}  // namespace corridor::reports
