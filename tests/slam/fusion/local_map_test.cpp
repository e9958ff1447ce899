#include "slam/fusion/local_map.hpp"

#include <gtest/gtest.h>

#include "tests/slam/fusion/drive.hpp"

namespace corridor::fusion {
namespace {

TEST(LocalMap, TwoSubmapsOverlapByHalf) {
  FusionParams params;
  params.submap_key_scans = 10;
  Drive run(params);
  for (int i = 0; i < 25; ++i) run.add({0.1 * i - 1, 0, 0}, 0.1 * i);
  // Origins at 0, 5, 10, 15, 20; those from 0, 5, 10, 15 are full after 10, 15, 20, 25 key scans.
  EXPECT_EQ(run.map.num_submaps(), 5u);
  ASSERT_EQ(run.map.finished().size(), 4u);
  EXPECT_EQ(run.map.finished()[1]->scans().front().key, 5u);
  EXPECT_EQ(run.map.finished()[1]->num_scans(), 10);
  EXPECT_EQ(run.map.active().scans().front().key, 20u);
}

TEST(LocalMap, WithoutSubmapsMatchesAgainstTheLastKeyScan) {
  FusionParams params = fusion_paper_params();
  Drive run(params);
  for (int i = 0; i < 5; ++i) {
    run.add({0.1 * i, 0, 0}, 0.1 * i);
    EXPECT_EQ(run.map.active().frame(), static_cast<std::uint32_t>(i));
    EXPECT_EQ(run.map.active().num_scans(), 1);
  }
}

}  // namespace
}  // namespace corridor::fusion
