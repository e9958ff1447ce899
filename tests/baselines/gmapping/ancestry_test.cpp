#include "baselines/gmapping/ancestry.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace corridor::gmapping {
namespace {

TEST(Ancestry, GivesThePathFromTheRootThroughSharedNodes) {
  Ancestry tree;
  const std::size_t root = tree.add(Pose2(0, 0, 0), Ancestry::kNoParent);
  const std::size_t left = tree.add(Pose2(1, 1, 0), root);
  const std::size_t right = tree.add(Pose2(1, -1, 0), root);
  const std::size_t leaf = tree.add(Pose2(2, -1, 0), right);
  EXPECT_EQ(tree.path_to(leaf),
            (std::vector<Pose2>{Pose2(0, 0, 0), Pose2(1, -1, 0), Pose2(2, -1, 0)}));
  EXPECT_EQ(tree.path_to(left), (std::vector<Pose2>{Pose2(0, 0, 0), Pose2(1, 1, 0)}));
  EXPECT_TRUE(tree.path_to(Ancestry::kNoParent).empty());
}

}  // namespace
}  // namespace corridor::gmapping
