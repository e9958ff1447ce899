#include "bench/statistics/wilson.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace corridor::statistics {
namespace {

constexpr double kExact = 1e-13;

TEST(NormalQuantile, AgreesWithPublishedValues) {
  // Abramowitz & Stegun, table 26.5 and usual tables.
  EXPECT_NEAR(*normal_quantile(0.975), 1.959963984540054, kExact);
  EXPECT_NEAR(*normal_quantile(0.95), 1.6448536269514722, kExact);
  EXPECT_NEAR(*normal_quantile(0.995), 2.5758293035489004, kExact);
  EXPECT_NEAR(*normal_quantile(0.5), 0, kExact);
  EXPECT_NEAR(*normal_quantile(1e-10), -6.361340902404056, 1e-12);
}

TEST(NormalQuantile, IsNothingOutsideTheOpenInterval) {
  for (const double p : {0.0, 1.0, -0.1, 1.1, std::nan("")}) EXPECT_FALSE(normal_quantile(p)) << p;
}

// [Newcombe1998], Statistics in Medicine 17:857, table I, method 3: four cases at 95 %.
TEST(WilsonInterval, AgreesWithNewcombesTable) {
  struct Case {
    std::int64_t successes, trials;
    double low, high;
  };
  for (const Case& c : {Case{81, 263, 0.2553, 0.3662}, Case{15, 148, 0.0624, 0.1605},
                        Case{0, 20, 0.0000, 0.1611}, Case{1, 29, 0.0061, 0.1718}}) {
    const auto interval = wilson_interval(c.successes, c.trials);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, c.low, 5e-5) << c.successes;
    EXPECT_NEAR(interval->high, c.high, 5e-5) << c.successes;
  }
}

// Second implementation: both ends solve the score equation (x - n p)^2 = z^2 n p (1 - p) for p.
RC_GTEST_PROP(WilsonInterval, EndsSolveTheScoreEquation, ()) {
  const auto n = *rc::gen::inRange<std::int64_t>(1, 500);
  const auto x = *rc::gen::inRange<std::int64_t>(0, n + 1);
  const auto interval = wilson_interval(x, n);
  RC_ASSERT(interval.has_value());
  const auto trials = static_cast<double>(n);
  const double z = 1.959963984540054;
  for (const double p : {interval->low, interval->high}) {
    const double left = std::pow(static_cast<double>(x) - trials * p, 2);
    RC_ASSERT(std::abs(left - z * z * trials * p * (1 - p)) < 1e-9 * trials * trials);
  }
  RC_ASSERT(0 <= interval->low && interval->low <= interval->value);
  RC_ASSERT(interval->value <= interval->high && interval->high <= 1);
}

TEST(WilsonInterval, IsNothingForBadInput) {
  EXPECT_FALSE(wilson_interval(0, 0));
  EXPECT_FALSE(wilson_interval(-1, 5));
  EXPECT_FALSE(wilson_interval(6, 5));
  EXPECT_FALSE(wilson_interval(1, 5, 1.0));
  EXPECT_FALSE(wilson_interval(1, 5, 0.0));
}

}  // namespace
}  // namespace corridor::statistics
