#include "bench/statistics/quantiles.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corridor::statistics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The usual textbook example of the nearest-rank method.
TEST(Percentile, AgreesWithTheTextbookExample) {
  const std::vector<double> values{15, 20, 35, 40, 50};
  EXPECT_EQ(percentile(values, 5), 15);
  EXPECT_EQ(percentile(values, 30), 20);
  EXPECT_EQ(percentile(values, 40), 20);
  EXPECT_EQ(percentile(values, 50), 35);
  EXPECT_EQ(percentile(values, 100), 50);
  EXPECT_EQ(percentile(values, 0), 15);
}

TEST(Percentile, RankIsNotMovedByRounding) {
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i + 1);
  for (int p = 1; p <= 100; ++p) EXPECT_EQ(percentile(values, p), p) << p;
  values.resize(20);
  EXPECT_EQ(percentile(values, 95), 19);
}

// Second implementation: by definition, without sorting or ranks.
double percentile_by_counting(const std::vector<double>& values, int percent) {
  double best = kInfinity;
  for (const double candidate : values) {
    const auto count =
        std::count_if(values.begin(), values.end(), [&](double x) { return x <= candidate; });
    if (100 * count >= static_cast<std::ptrdiff_t>(values.size()) * percent) {
      best = std::min(best, candidate);
    }
  }
  return best;
}

RC_GTEST_PROP(Percentile, EqualsTheDefinitionByCounting, ()) {
  const auto integers =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-20, 20)));
  const std::vector<double> values(integers.begin(), integers.end());
  const int percent = *rc::gen::inRange(0, 101);
  RC_ASSERT(percentile(values, percent) == percentile_by_counting(values, percent));
}

TEST(Percentile, IsNothingForBadInput) {
  EXPECT_FALSE(percentile({}, 50));
  EXPECT_FALSE(percentile(std::vector{1.0, kNan}, 50));
  EXPECT_FALSE(percentile(std::vector{1.0}, -1));
  EXPECT_FALSE(percentile(std::vector{1.0}, 101));
  EXPECT_FALSE(percentile(std::vector{1.0}, kNan));
}

TEST(Percentile, OrdersInfiniteValues) {
  EXPECT_EQ(percentile(std::vector{kInfinity, 1.0, 2.0}, 99), kInfinity);
  EXPECT_EQ(percentile(std::vector{kInfinity, 1.0, 2.0}, 50), 2.0);
}

TEST(Median, IsTheMiddleValueOrTheMeanOfTheTwo) {
  EXPECT_EQ(median(std::vector{3.0}), 3);
  EXPECT_EQ(median(std::vector{3.0, 1.0}), 2);
  EXPECT_EQ(median(std::vector{9.0, 1.0, 2.0}), 2);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 3.0, 2.0}), 2.5);
}

TEST(Median, IsNothingForBadInput) {
  EXPECT_FALSE(median({}));
  EXPECT_FALSE(median(std::vector{kNan}));
  EXPECT_FALSE(median(std::vector{-kInfinity, kInfinity}));
}

TEST(Median, DoesNotOverflow) {
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(median(std::vector{huge, huge}), huge);
  EXPECT_TRUE(std::isfinite(*median(std::vector{huge, 0.9 * huge})));
}

RC_GTEST_PROP(Median, HasHalfOfTheValuesOnEachSide, ()) {
  const auto integers =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-50, 50)));
  const std::vector<double> values(integers.begin(), integers.end());
  const double middle = *median(values);
  const auto below =
      std::count_if(values.begin(), values.end(), [&](double x) { return x < middle; });
  const auto above =
      std::count_if(values.begin(), values.end(), [&](double x) { return x > middle; });
  RC_ASSERT(2 * below <= static_cast<std::ptrdiff_t>(values.size()));
  RC_ASSERT(2 * above <= static_cast<std::ptrdiff_t>(values.size()));
}

}  // namespace
}  // namespace corridor::statistics
