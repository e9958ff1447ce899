#include "slam/core/rng.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace corridor {
namespace {

using Words = std::array<std::uint32_t, 4>;

// Second implementation of Philox4x32-10, from the definition in [Salmon2011] section 3.3.
Words philox4x32_10(Words counter, std::uint32_t key_0, std::uint32_t key_1) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product_0 = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t product_1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<std::uint32_t>(product_1 >> 32) ^ counter[1] ^ key_0,
               static_cast<std::uint32_t>(product_1),
               static_cast<std::uint32_t>(product_0 >> 32) ^ counter[3] ^ key_1,
               static_cast<std::uint32_t>(product_0)};
    key_0 += 0x9E3779B9u;
    key_1 += 0xBB67AE85u;
  }
  return counter;
}

// The seed whose key is zero: SplitMix64's finaliser takes it to 0.
constexpr std::uint64_t kSeedOfKeyZero = 0 - 0x9e3779b97f4a7c15ULL;

// Known answers published with Random123, tests/kat_vectors, lines "philox4x32 10".
TEST(Philox, SecondImplementationGivesThePublishedKnownAnswers) {
  EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, 0, 0),
            (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32_10({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, IsPhiloxWithACountingBlockAndTheSeedsKey) {
  Rng rng(kSeedOfKeyZero);
  for (std::uint32_t block = 0; block < 1000; ++block) {
    for (const std::uint32_t word : philox4x32_10({block, 0, 0, 0}, 0, 0)) {
      ASSERT_EQ(rng.next_u32(), word) << "block " << block;
    }
  }
}

// Guards every published result: a change here changes every simulated log and every particle
// filter.
TEST(Rng, FirstNumbersOfASeedNeverChange) {
  Rng rng(1);
  EXPECT_EQ(rng.next_u32(), 2573676263u);
  EXPECT_EQ(rng.next_u32(), 3801379442u);
  Rng wheels = Rng(1).stream("wheels");
  EXPECT_EQ(wheels.next_u64(), 15040251271610144107u);
  Rng seventh = Rng(1).stream(std::uint64_t{7});
  EXPECT_EQ(seventh.next_u64(), 14118434483824395809u);
  EXPECT_EQ(Rng(1).uniform(), 0.599230701077049);
  EXPECT_NEAR(Rng(1).normal(), -1.2104472225561766,
              1e-15);  // logarithm and cosine are the C library's
}

RC_GTEST_PROP(Rng, SameSeedGivesTheSameNumbers, (std::uint64_t seed)) {
  Rng one(seed), other(seed);
  for (int i = 0; i < 100; ++i) RC_ASSERT(one.next_u64() == other.next_u64());
}

RC_GTEST_PROP(Rng, StreamDoesNotDependOnWhatWasDrawnBefore, (std::uint64_t seed)) {
  Rng parent(seed);
  Rng early = parent.stream("lidar");
  for (int i = 0; i < 17; ++i) parent.next_u32();
  Rng late = parent.stream("lidar");
  for (int i = 0; i < 10; ++i) RC_ASSERT(early.next_u64() == late.next_u64());
}

TEST(Rng, StreamsOfDifferentNamesIndicesAndDepthsShareNoNumber) {
  const Rng root(42);
  std::vector<Rng> generators{root,
                              root.stream("a"),
                              root.stream("b"),
                              root.stream("ab"),
                              root.stream("a").stream("b"),
                              root.stream("b").stream("a"),
                              root.stream(""),
                              Rng(43)};
  for (std::uint64_t i = 0; i < 100; ++i) generators.push_back(root.stream(i));
  std::set<std::uint64_t> seen;
  for (Rng& rng : generators) {
    for (int i = 0; i < 100; ++i) seen.insert(rng.next_u64());
  }
  EXPECT_EQ(seen.size(), generators.size() * 100);
}

// Correlation of two independent streams of n numbers is 0 +- 1 / sqrt(n).
TEST(Rng, NeighbouringStreamsAreUncorrelated) {
  constexpr int kNum = 20000;
  for (std::uint64_t index = 0; index < 10; ++index) {
    Rng one = Rng(5).stream(index);
    Rng other = Rng(5).stream(index + 1);
    double sum = 0;
    for (int i = 0; i < kNum; ++i) sum += one.normal() * other.normal();
    EXPECT_LT(std::abs(sum / kNum), 5 / std::sqrt(double{kNum})) << "streams from " << index;
  }
}

TEST(Rng, UniformHasTheMomentsOfTheUnitInterval) {
  constexpr int kNum = 200000;
  Rng rng(11);
  double sum = 0;
  double sum_of_squares = 0;
  for (int i = 0; i < kNum; ++i) {
    const double value = rng.uniform();
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 1);
    sum += value;
    sum_of_squares += value * value;
  }
  const double root = std::sqrt(double{kNum});
  EXPECT_NEAR(sum / kNum, 1.0 / 2, 5 * std::sqrt(1.0 / 12) / root);
  EXPECT_NEAR(sum_of_squares / kNum, 1.0 / 3, 5 * std::sqrt(4.0 / 45) / root);
}

TEST(Rng, NormalHasTheFirstFourMoments) {
  constexpr int kNum = 200000;
  Rng rng(12);
  double sums[5] = {};
  for (int i = 0; i < kNum; ++i) {
    const double value = rng.normal();
    for (int k = 1; k <= 4; ++k) sums[k] += std::pow(value, k);
  }
  // Variances of the powers of a standard normal: 1, 2, 15, 96.
  const double root = std::sqrt(double{kNum});
  EXPECT_NEAR(sums[1] / kNum, 0, 5 * std::sqrt(1.0) / root);
  EXPECT_NEAR(sums[2] / kNum, 1, 5 * std::sqrt(2.0) / root);
  EXPECT_NEAR(sums[3] / kNum, 0, 5 * std::sqrt(15.0) / root);
  EXPECT_NEAR(sums[4] / kNum, 3, 5 * std::sqrt(96.0) / root);
}

TEST(Rng, NormalFillsItsTailsAsItShould) {
  constexpr int kNum = 200000;
  Rng rng(13);
  int num_beyond_3_sigma = 0;
  for (int i = 0; i < kNum; ++i) num_beyond_3_sigma += std::abs(rng.normal(5, 2) - 5) > 6;
  const double share = 0.0026998;
  EXPECT_NEAR(num_beyond_3_sigma, share * kNum, 5 * std::sqrt(share * kNum));
}

RC_GTEST_PROP(Rng, BelowStaysBelow, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::uint64_t bound = 1 + rng.next_u64() / (1 + rng.next_u32());
  for (int i = 0; i < 100; ++i) RC_ASSERT(rng.below(bound) < bound);
}

TEST(Rng, BelowIsUnbiased) {
  constexpr int kNum = 120000;
  Rng rng(14);
  std::array<int, 12> counts{};
  for (int i = 0; i < kNum; ++i) ++counts[rng.below(12)];
  for (const int count : counts) EXPECT_NEAR(count, kNum / 12, 5 * std::sqrt(kNum / 12.0));
}

// 2^64 mod bound is nearly bound: without rejection the lower half would come twice as often.
TEST(Rng, BelowIsUnbiasedForBoundsNearTheTopOfTheRange) {
  constexpr int kNum = 20000;
  constexpr std::uint64_t kBound = (std::uint64_t{1} << 63) + (std::uint64_t{1} << 62);
  Rng rng(15);
  int num_low = 0;
  for (int i = 0; i < kNum; ++i) num_low += rng.below(kBound) < kBound / 3;
  EXPECT_NEAR(num_low, kNum / 3.0, 5 * std::sqrt(kNum * 2.0 / 9));
}

TEST(Rng, BelowOneIsZero) { EXPECT_EQ(Rng(1).below(1), 0u); }

TEST(RngDeathTest, BelowZeroBreaksItsContract) {
  EXPECT_DEATH(Rng(1).below(0), "contract broken: bound > 0");
}

}  // namespace
}  // namespace corridor
