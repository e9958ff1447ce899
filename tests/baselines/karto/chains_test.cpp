// Small worlds: key scans along a line, out and back, with links as the mapper makes them.
#include "baselines/karto/chains.hpp"

#include <gtest/gtest.h>

namespace corridor::karto {
namespace {

// 20 scans one metre apart along x, then the way back 0.5 m beside it. Consecutive scans are
// linked.
class ThereAndBack : public ::testing::Test {
 protected:
  ThereAndBack() {
    for (int i = 0; i < 40; ++i) {
      const double x = i < 20 ? i : 39 - i;
      references.emplace_back(x, i < 20 ? 0.0 : 0.5);
      links.add_scan();
      if (i > 0) links.link(static_cast<KeyScanId>(i - 1), static_cast<KeyScanId>(i));
    }
  }

  std::vector<Eigen::Vector2d> references;
  ScanLinks links;
};

TEST(ScanLinks, TheFirstEdgeBetweenTwoScansWins) {
  ScanLinks links;
  links.add_scan();
  links.add_scan();
  EXPECT_TRUE(links.link(0, 1));
  EXPECT_FALSE(links.link(0, 1));
  EXPECT_FALSE(links.link(1, 0));
  EXPECT_FALSE(links.link(1, 1));
}

TEST_F(ThereAndBack, AWalkOverEdgesStopsWhereScansAreFar) {
  // From 30 (x = 9) within 3.5 m: 27..33 by edges; 6..12 are near, but no edge leads there.
  const auto reached = links.reachable(
      30, [&](KeyScanId id) { return (references[id] - references[30]).norm() <= 3.5; });
  EXPECT_EQ(reached, (std::vector<KeyScanId>{30, 29, 31, 28, 32, 27, 33}));
}

TEST_F(ThereAndBack, ARunWithTheScanItselfIsNoEarlierPass) {
  EXPECT_TRUE(near_chains(links, references, 39, 6, 1).empty());
}

TEST_F(ThereAndBack, AnEarlierPassReachedByALinkIsExtendedToItsWholeRun) {
  links.link(2, 38);
  // Newest scan at x = 0: the earlier pass within 6 m is 0..5 (5.02 m), reached through 38.
  EXPECT_EQ(near_chains(links, references, 39, 6, 6), (std::vector<Chain>{{0, 5}}));
  EXPECT_TRUE(near_chains(links, references, 39, 6, 7).empty());
}

TEST_F(ThereAndBack, AnUnlinkedRunOfConsecutiveScansIsALoopCandidate) {
  // Within 4 m of the newest at x = 0: ids 0..3; the rest of the way back is linked to it.
  EXPECT_EQ(next_loop_candidate(links, references, 39, 0, 4, 3), (Chain{0, 3}));
  EXPECT_EQ(next_loop_candidate(links, references, 39, 4, 4, 3), std::nullopt);
}

TEST_F(ThereAndBack, ARunThatIsTooShortIsNoCandidate) {
  EXPECT_EQ(next_loop_candidate(links, references, 39, 0, 4, 5), std::nullopt);
}

TEST_F(ThereAndBack, ALinkedScanClearsTheRunBeforeIt) {
  links.link(2, 39);
  // 2 is linked, and by edges inside the radius so are 0, 1 and 3: nothing is left.
  EXPECT_EQ(next_loop_candidate(links, references, 39, 0, 4, 1), std::nullopt);
}

TEST(LoopCandidate, ALinkedScanInARunLeavesOnlyWhatFollowsIt) {
  // All at one place, no edges but 2 - 5: from 5, scan 2 is linked; 0, 1 are cleared by it.
  ScanLinks links;
  std::vector<Eigen::Vector2d> references(6, Eigen::Vector2d::Zero());
  references[4] = {100, 0};
  for (int i = 0; i < 6; ++i) links.add_scan();
  links.link(2, 5);
  EXPECT_EQ(next_loop_candidate(links, references, 5, 0, 4, 1), (Chain{3, 3}));
}

TEST(LoopCandidate, ARunThatReachesTheEndOfTheListIsReturnedWhateverItsLength) {
  ScanLinks links;
  for (int i = 0; i < 4; ++i) links.add_scan();
  const std::vector<Eigen::Vector2d> references = {{0, 0}, {50, 0}, {50, 0}, {0, 1}};
  EXPECT_EQ(next_loop_candidate(links, references, 0, 1, 4, 10), (Chain{3, 3}));
}

TEST(ClosestIn, TakesTheEarliestOfEqualOnes) {
  const std::vector<Eigen::Vector2d> references = {{9, 0}, {1, 0}, {-1, 0}, {0, 1}};
  EXPECT_EQ(closest_in({0, 3}, {0, 0}, references), 1u);
  EXPECT_EQ(closest_in({2, 3}, {0, 0}, references), 2u);
}

}  // namespace
}  // namespace corridor::karto
