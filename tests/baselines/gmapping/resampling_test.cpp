#include "baselines/gmapping/resampling.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>

#include "slam/core/rng.hpp"

namespace corridor::gmapping {
namespace {

constexpr double kExact = 1e-12;

TEST(NormalisedWeights, EqualTheHandComputedOnes) {
  // Gain 3 and two particles: exponents 0 and -6 / 6.
  const std::vector<double> weights = normalised_weights(std::vector<double>{-4.0, -10.0}, 3);
  EXPECT_NEAR(weights[0], 1 / (1 + std::exp(-1)), kExact);
  EXPECT_NEAR(weights[1], std::exp(-1) / (1 + std::exp(-1)), kExact);
}

TEST(NormalisedWeights, SurviveLogWeightsFarBelowTheExponentsRange) {
  const std::vector<double> weights =
      normalised_weights(std::vector<double>{-1e7, -1e7, -2e8}, 1e-3);
  EXPECT_NEAR(weights[0], 0.5, kExact);
  EXPECT_EQ(weights[2], 0.0);
}

RC_GTEST_PROP(NormalisedWeights, SumToOneAndKeepTheOrder, (std::uint64_t seed)) {
  Rng rng(seed);
  std::vector<double> log_weights(2 + rng.below(50));
  for (double& log_weight : log_weights) log_weight = rng.uniform(-2000, 0);
  const std::vector<double> weights = normalised_weights(log_weights, 3);
  RC_ASSERT(std::abs(std::accumulate(weights.begin(), weights.end(), 0.0) - 1) < kExact);
  for (std::size_t i = 1; i < weights.size(); ++i) {
    RC_ASSERT((log_weights[i] > log_weights[i - 1]) == (weights[i] > weights[i - 1]));
  }
}

TEST(EffectiveSampleSize, IsTheNumberForEqualWeightsAndOneForASurvivor) {
  EXPECT_NEAR(effective_sample_size(std::vector<double>(30, 1.0 / 30)), 30, 1e-9);
  EXPECT_NEAR(effective_sample_size(std::vector<double>{0, 1, 0}), 1, kExact);
  EXPECT_NEAR(effective_sample_size(std::vector<double>{0.5, 0.25, 0.25}), 1 / 0.375, kExact);
}

TEST(SystematicResample, WalksTheTargetsOfAHandComputedCase) {
  // Targets 0.125, 0.375, 0.625, 0.875 over the cumulative sums 0.2, 0.6, 0.65, 1.
  EXPECT_EQ(systematic_resample(std::vector<double>{0.2, 0.4, 0.05, 0.35}, 0.5),
            (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(systematic_resample(std::vector<double>{0.0, 0.0, 1.0}, 0.0),
            (std::vector<std::size_t>{2, 2, 2}));
}

TEST(SystematicResample, IsUnbiasedWithinFiveSigma) {
  const std::vector<double> weights = {0.5, 0.013, 0.2, 0.007, 0.28};
  constexpr int kNumDraws = 20000;
  std::vector<double> counts(weights.size(), 0);
  Rng rng(3);
  for (int draw = 0; draw < kNumDraws; ++draw) {
    for (const std::size_t index : systematic_resample(weights, rng.uniform())) ++counts[index];
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = 5 * weights[i];
    const double fraction = expected - std::floor(expected);
    // One draw is floor(expected) or one more: a Bernoulli variable.
    const double sigma = std::sqrt(fraction * (1 - fraction) / kNumDraws);
    EXPECT_NEAR(counts[i] / kNumDraws, expected, 5 * sigma + kExact) << i;
  }
}

RC_GTEST_PROP(SystematicResample, ChoosesEachIndexFloorOrCeilOfItsShareTimes,
              (std::uint64_t seed)) {
  Rng rng(seed);
  std::vector<double> weights(1 + rng.below(40));
  for (double& weight : weights) weight = rng.uniform();
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const std::vector<std::size_t> chosen = systematic_resample(weights, rng.uniform());
  RC_ASSERT(chosen.size() == weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double share = weights[i] / sum * static_cast<double>(weights.size());
    const auto count = static_cast<double>(std::count(chosen.begin(), chosen.end(), i));
    RC_ASSERT(count > share - 1 - 1e-9 && count < share + 1 + 1e-9);
  }
}

}  // namespace
}  // namespace corridor::gmapping
