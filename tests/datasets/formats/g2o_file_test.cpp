#include "datasets/formats/graphs/g2o_file.hpp"

#include <gtest/gtest.h>

#include "slam/graph/factors/pose_factors.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using graph::pose_key;
using test::read_text;
using test::ScratchFolder;

graph::NewFactor edge(std::uint32_t i, std::uint32_t j, const Pose2& T_i_j) {
  const Eigen::Matrix3d root = Eigen::Vector3d(2, 3, 4).asDiagonal();
  return graph::RelativePose(pose_key(i), pose_key(j), T_i_j, root);
}

TEST(G2oFile, HoldsPosesAndRelativePosesInG2osOrder) {
  graph::Values values;
  values.set_pose(0, Pose2(0, 0, 0));
  values.set_pose(1, Pose2(1, 0.5, 0.25));
  values.set_velocity(0, Eigen::Vector2d::Zero());
  graph::FactorGraph factors;
  factors.add(edge(0, 1, Pose2(1, 0.5, 0.25)));
  const ScratchFolder folder;
  ASSERT_TRUE(write_g2o(factors, values, folder / "g.g2o"));
  EXPECT_EQ(read_text(folder / "g.g2o"),
            "# left out: 1 variables that are not poses\n"
            "VERTEX_SE2 0 0 0 0\n"
            "VERTEX_SE2 1 1 0.5 0.25\n"
            "FIX 0\n"
            "EDGE_SE2 0 1 1 0.5 0.25 4 0 0 9 0 16\n");
}

TEST(G2oFile, FixesThePosesThatHaveAPrior) {
  graph::Values values;
  values.set_pose(0, Pose2());
  values.set_pose(3, Pose2());
  graph::FactorGraph factors;
  factors.add(graph::PosePrior(pose_key(3), Pose2(), Eigen::Matrix3d::Identity()));
  const ScratchFolder folder;
  ASSERT_TRUE(write_g2o(factors, values, folder / "g.g2o"));
  const std::string text = read_text(folder / "g.g2o");
  EXPECT_NE(text.find("FIX 3\n"), std::string::npos);
  EXPECT_EQ(text.find("FIX 0\n"), std::string::npos);
}

TEST(G2oFile, LeavesOutRemovedFactors) {
  graph::Values values;
  values.set_pose(0, Pose2());
  values.set_pose(1, Pose2());
  graph::FactorGraph factors;
  const auto id = factors.add(edge(0, 1, Pose2()));
  factors.remove(id);
  const ScratchFolder folder;
  ASSERT_TRUE(write_g2o(factors, values, folder / "g.g2o"));
  EXPECT_EQ(read_text(folder / "g.g2o").find("EDGE_SE2"), std::string::npos);
}

}  // namespace
}  // namespace corridor::formats
