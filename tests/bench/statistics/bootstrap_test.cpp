#include "bench/statistics/bootstrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "bench/statistics/paired_ratio.hpp"
#include "bench/statistics/quantiles.hpp"
#include "slam/core/rng.hpp"

namespace corridor::statistics {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Second implementation: all n^n resamples of a small sample, each equally likely, instead of
// random ones.
std::vector<double> all_resampled_medians(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<std::size_t> digits(n, 0);
  std::vector<double> medians;
  std::vector<double> resample(n);
  while (true) {
    std::transform(digits.begin(), digits.end(), resample.begin(),
                   [&](std::size_t digit) { return values[digit]; });
    medians.push_back(*median(resample));
    std::size_t position = 0;
    while (position < n && ++digits[position] == n) digits[position++] = 0;
    if (position == n) return medians;
  }
}

TEST(Bootstrap, MedianIntervalEqualsTheExhaustiveOne) {
  const std::vector<double> values{1.3, 4.1, 2.2, 9.5, 7.0};
  const auto exhaustive = all_resampled_medians(values);
  for (const double confidence : {0.5, 0.8, 0.95}) {
    BootstrapOptions options;
    options.confidence = confidence;
    const auto interval = bootstrap_median(values, options);
    ASSERT_TRUE(interval);
    EXPECT_EQ(interval->value, 4.1);
    EXPECT_EQ(interval->low, percentile(exhaustive, 50 * (1 - confidence))) << confidence;
    EXPECT_EQ(interval->high, percentile(exhaustive, 50 * (1 + confidence))) << confidence;
  }
}

// For n = 5 distinct values the median is the smallest one with probability 0.2^5 * sum ... =
// 0.05792 (binomial: at least 3 of 5 draws hit it), so 95 % reaches the minimum and 85 % does not.
TEST(Bootstrap, MedianOfFiveReachesTheMinimumAtTheHandComputedConfidence) {
  const std::vector<double> values{1, 2, 3, 4, 5};
  BootstrapOptions options;
  options.confidence = 0.95;
  EXPECT_EQ(bootstrap_median(values, options)->low, 1);
  options.confidence = 0.85;
  EXPECT_EQ(bootstrap_median(values, options)->low, 2);
}

TEST(Bootstrap, MeanIntervalApproachesTheNormalOne) {
  Rng rng(3);
  std::vector<double> values(400);
  for (double& value : values) value = rng.normal(10, 2);
  const auto interval = bootstrap_interval(values, mean);
  ASSERT_TRUE(interval);
  double variance = 0;
  for (const double value : values) variance += std::pow(value - mean(values), 2);
  const double half = 1.96 * std::sqrt(variance) / 400;
  EXPECT_NEAR(interval->low, mean(values) - half, 0.05 * half);
  EXPECT_NEAR(interval->high, mean(values) + half, 0.05 * half);
}

TEST(Bootstrap, MedianIntervalCoversTheTrueMedianAboutAsStated) {
  Rng rng(17);
  int num_covered = 0;
  constexpr int kNumSamples = 400;
  BootstrapOptions options;
  options.num_resamples = 500;
  for (int i = 0; i < kNumSamples; ++i) {
    std::vector<double> values(15);
    for (double& value : values) value = std::exp(rng.normal());  // true median 1, skewed
    const auto interval = bootstrap_median(values, options);
    if (interval->low <= 1 && 1 <= interval->high) ++num_covered;
  }
  // 95 % nominal; order statistics of 15 values give 0.92 to 0.97.
  EXPECT_GE(num_covered, 0.90 * kNumSamples);
  EXPECT_LE(num_covered, 0.985 * kNumSamples);
}

TEST(Bootstrap, SameSeedGivesSameBytesAndAnotherSeedDoesNot) {
  Rng rng(5);
  std::vector<double> values(30);
  for (double& value : values) value = rng.normal();
  BootstrapOptions other;
  other.seed = 2;
  EXPECT_EQ(bootstrap_interval(values, mean), bootstrap_interval(values, mean));
  EXPECT_NE(bootstrap_interval(values, mean), bootstrap_interval(values, mean, other));
}

TEST(Bootstrap, OneValueIsItsOwnInterval) {
  const auto interval = bootstrap_median(std::array{4.2});
  ASSERT_TRUE(interval);
  EXPECT_EQ(*interval, (Estimate{4.2, 4.2, 4.2, 0.95, 1}));
}

TEST(Bootstrap, IsNothingForBadInput) {
  const std::vector<double> good{1, 2, 3};
  EXPECT_FALSE(bootstrap_median({}));
  EXPECT_FALSE(bootstrap_median(std::array{1.0, std::nan("")}));
  EXPECT_FALSE(bootstrap_median(std::array{1.0, std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(bootstrap_median(good, {.num_resamples = 0}));
  EXPECT_FALSE(bootstrap_median(good, {.confidence = 1.0}));
  EXPECT_FALSE(bootstrap_interval(good, [](std::span<const double>) { return std::nan(""); }));
}

TEST(PairedRatio, OfAConstantFactorIsThatFactorWithoutWidth) {
  const std::vector<double> baseline{1, 2, 3, 5, 8};
  std::vector<double> candidate(baseline);
  for (double& value : candidate) value *= 0.5;
  const auto ratio = paired_ratio(baseline, candidate);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->value, 0.5, 1e-15);
  EXPECT_NEAR(ratio->low, 0.5, 1e-15);
  EXPECT_NEAR(ratio->high, 0.5, 1e-15);
}

TEST(PairedRatio, MedianIsHandComputed) {
  // Ratios 2, 1/2, 4: the middle one is 2, whatever the sizes of the values.
  EXPECT_NEAR(paired_ratio(std::array{1.0, 100.0, 0.01}, std::array{2.0, 50.0, 0.04})->value, 2,
              1e-12);
  // Ratios 2 and 8: the median of the logarithms is that of 4, their geometric mean.
  EXPECT_NEAR(paired_ratio(std::array{1.0, 1.0}, std::array{2.0, 8.0})->value, 4, 1e-12);
}

TEST(PairedRatio, OfTheExchangedRolesIsTheInverse) {
  Rng rng(9);
  std::vector<double> a(11), b(11);
  for (double& value : a) value = std::exp(rng.normal());
  for (double& value : b) value = std::exp(rng.normal());
  const auto forward = paired_ratio(a, b);
  const auto backward = paired_ratio(b, a);
  EXPECT_NEAR(forward->value * backward->value, 1, 1e-12);
  // Nearest rank takes the lower end at rank 250 and the upper at 9750 of 10 000: mirrored within a
  // rank.
  EXPECT_NEAR(forward->low * backward->high, 1, 0.05);
}

TEST(PairedRatio, AgainstItselfAlertsNoMoreOftenThanStated) {
  Rng rng(23);
  constexpr int kNumComparisons = 300;
  int num_alerts = 0;
  for (int i = 0; i < kNumComparisons; ++i) {
    std::vector<double> a(9), b(9);
    for (std::size_t k = 0; k < a.size(); ++k) {
      a[k] = std::exp(0.05 * rng.normal());
      b[k] = std::exp(0.05 * rng.normal());
    }
    const auto ratio = paired_ratio(a, b);
    if (ratio->low > 1 || ratio->high < 1) ++num_alerts;
  }
  // For n = 9 the interval runs from the 2nd to the 8th ratio: 2 * (1 + 9) / 2^9 = 3.9 % alerts; a
  // standard deviation of 300 comparisons is 1.1 %.
  EXPECT_LE(num_alerts, 0.073 * kNumComparisons);
  EXPECT_GE(num_alerts, 0.005 * kNumComparisons);
}

TEST(PairedRatio, IsNothingForBadInput) {
  EXPECT_FALSE(paired_ratio({}, {}));
  EXPECT_FALSE(paired_ratio(std::array{1.0}, std::array{1.0, 2.0}));
  EXPECT_FALSE(paired_ratio(std::array{1.0}, std::array{0.0}));
  EXPECT_FALSE(paired_ratio(std::array{-1.0}, std::array{1.0}));
  EXPECT_FALSE(paired_ratio(std::array{1.0}, std::array{std::nan("")}));
}

}  // namespace
}  // namespace corridor::statistics
