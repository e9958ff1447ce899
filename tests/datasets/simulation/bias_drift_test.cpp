#include "datasets/simulation/bias_drift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kFlatPerInstability = 0.664;

std::vector<double> drift(double instability, double walk, std::size_t num_steps,
                          std::uint64_t seed) {
  BiasDrift drift(instability, walk, kStep_s, Rng(seed));
  std::vector<double> biases;
  for (std::size_t i = 0; i < num_steps; ++i) biases.push_back(drift.advance());
  return biases;
}

TEST(BiasDrift, IsZeroWithoutInstabilityAndWalk) {
  for (const double bias : drift(0, 0, 100, 1)) EXPECT_EQ(bias, 0);
}

// A tenth for the sum of Gauss-Markov processes, the rest for the estimate.
TEST(BiasDrift, AllanDeviationIsFlatAtItsBottomFromOneToHundredsOfSeconds) {
  const double instability = 0.3;
  const auto biases = drift(instability, 0, 1'000'000, 1);
  for (const std::size_t num_per_cluster : {10u, 100u, 1000u, 5000u}) {
    const double deviation = allan_deviation(biases, num_per_cluster);
    EXPECT_NEAR(deviation / (kFlatPerInstability * instability), 1,
                0.1 + allan_tolerance(biases.size() / num_per_cluster))
        << num_per_cluster / 10 << " s";
    RecordProperty("ratio_at_" + std::to_string(num_per_cluster / 10) + "_s",
                   std::to_string(deviation / (kFlatPerInstability * instability)));
  }
}

TEST(BiasDrift, WalkGrowsWithTheRootOfAThirdOfTheTime) {
  const double walk = 0.02;
  const auto biases = drift(0, walk, 500'000, 2);
  for (const std::size_t num_per_cluster : {100u, 1000u, 5000u}) {
    // Of steps kStep_s apart: 2 k^2 + 1 in the place of 2 k^2, less than 1e-4 here.
    const double expected = walk * std::sqrt(kStep_s * static_cast<double>(num_per_cluster) / 3);
    EXPECT_NEAR(allan_deviation(biases, num_per_cluster) / expected, 1,
                allan_tolerance(biases.size() / num_per_cluster))
        << num_per_cluster / 10 << " s";
  }
}

TEST(BiasDrift, WalkBeginsAtZero) {
  std::vector<double> first;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) first.push_back(drift(0, 0.02, 1, seed)[0]);
  const double expected = 0.02 * std::sqrt(kStep_s);
  EXPECT_NEAR(standard_deviation(first), expected, expected * five_sigma(first.size()));
}

// Each of the nine processes has the variance B^2 ln(4) / pi, from the first moment to the last.
TEST(BiasDrift, InstabilityIsAsIfItHadRunForEver) {
  std::vector<double> first, last;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const auto biases = drift(1, 0, 50, seed);
    first.push_back(biases.front());
    last.push_back(biases.back());
  }
  const double expected = std::sqrt(9 * std::log(4.0) / std::numbers::pi);
  EXPECT_NEAR(standard_deviation(first), expected, expected * five_sigma(first.size()));
  EXPECT_NEAR(standard_deviation(last), expected, expected * five_sigma(last.size()));
}

TEST(BiasDrift, DoesNotDependOnTheStep) {
  std::vector<double> coarse, fine;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    BiasDrift slow(1, 0.5, 1.0, Rng(seed)), fast(1, 0.5, 0.1, Rng(seed + 100'000));
    const double slow_begin = slow.advance(), fast_begin = fast.advance();
    double fast_end = 0;
    for (int k = 0; k < 50; ++k) fast_end = fast.advance();
    double slow_end = 0;
    for (int k = 0; k < 5; ++k) slow_end = slow.advance();
    coarse.push_back(slow_end - slow_begin);
    fine.push_back(fast_end - fast_begin);
  }
  // Two estimates, each with its own error.
  EXPECT_NEAR(standard_deviation(coarse) / standard_deviation(fine), 1,
              std::sqrt(2) * five_sigma(coarse.size()));
}

}  // namespace
}  // namespace corridor::simulation::testing
