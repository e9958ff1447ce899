// Trajectories, relations, graphs, maps and robot models written by hand
// (tests/golden/README.md), value by value.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/formats/trajectories/trajectory_io.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats {
namespace {

using test::golden_file;
using test::golden_parts;
using test::read_text;
using test::ScratchFolder;
using test::write_text;

constexpr double kPi = std::numbers::pi;
// The quaternions of the files have seven digits.
constexpr double kPrinted = 1e-7;

struct KnownPose {
  std::int64_t stamp_ns;
  Pose2 T_map_base;
};

void expect_poses(const std::filesystem::path& path, const std::vector<KnownPose>& known) {
  const auto read = read_trajectory(path);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  ASSERT_EQ(read->trajectory.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(read->trajectory[i].stamp.nanoseconds, known[i].stamp_ns) << i;
    EXPECT_LT(read->trajectory[i].T_map_base.minus(known[i].T_map_base).norm(), kPrinted) << i;
  }
}

// Twice the angle whose cosine is -0.8 and whose sine is 0.6.
const double kTurned_rad = 2 * std::atan2(0.6, -0.8);

TEST(GoldenTexts, Tum) {
  expect_poses(golden_file("tum/five.tum"), {{-500'000'000, Pose2(1, 2, 0)},
                                             {0, Pose2(1, 2, kPi / 2)},
                                             {250'000'000, Pose2(1, 2, kPi)},
                                             {500'000'001, Pose2(1, 2, kTurned_rad)},
                                             {1'000'000'000, Pose2(-0.0015, 2, 0)}});
}

TEST(GoldenTexts, Kitti) {
  const auto [poses, times] = golden_parts("kitti/five.kitti");
  const ScratchFolder folder;
  write_text(folder / "a.kitti", poses + "\n");
  write_text(folder / "a.times", times);
  expect_poses(folder / "a.kitti", {{0, Pose2()},
                                    {100'000'000, Pose2(1.5, -2, kPi / 2)},
                                    {200'000'000, Pose2(1.5, -2, kPi)},
                                    {300'000'000, Pose2(10, -2, std::atan2(0.6, 0.8))},
                                    {400'000'001, Pose2()}});
}

TEST(GoldenTexts, Euroc) {
  constexpr std::int64_t kBegin_ns = 1'403'636'579'758'555'392;
  expect_poses(golden_file("euroc/ground-truth.csv"),
               {{kBegin_ns, Pose2(1, 2, 0)},
                {kBegin_ns + 5'000'000, Pose2(1, 2, kPi / 2)},
                {kBegin_ns + 10'000'000, Pose2(1, 2, kTurned_rad)},
                {kBegin_ns + 15'000'000, Pose2(1, 2, 0)},
                {kBegin_ns + 20'000'000, Pose2(1, 2, 0)}});
}

TEST(GoldenTexts, CarmenTrajectories) {
  expect_poses(golden_file("carmen_trajectory/flaser.clf"),
               {{100'100'000'000, Pose2(0.05, 0, 0)},
                {100'200'000'000, Pose2(0.15, 0, 0.01)},
                {100'300'000'001, Pose2(0.15, 0, 3.14)},
                {100'400'000'000, Pose2(-0.001, 100, -3)},
                {100'500'000'000, Pose2()}});
  expect_poses(golden_file("carmen_trajectory/robotlaser.clf"),
               {{100'000'000'000, Pose2(0.2, 0, 0.1)}});
}

TEST(GoldenTexts, Relations) {
  const auto read = read_relations(golden_file("relations/two.relations"));
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  const std::vector<Relation> known = {
      {{100'000'000'000}, {101'500'000'000}, Pose2(1, -0.5, 0.1)},
      {{101'500'000'000}, {100'000'000'000}, Pose2(-1, 0.5, -0.1)}};
  EXPECT_EQ(*read, known);
}

TEST(GoldenTexts, G2o) {
  const auto graph = read_pose_graph(golden_file("pose_graph/square.g2o"));
  ASSERT_TRUE(graph.has_value()) << graph.error().to_line();
  ASSERT_EQ(graph->vertices.size(), 3U);
  EXPECT_EQ(graph->vertices[1].id, 1U);
  EXPECT_EQ(graph->vertices[1].T_map_base, Pose2(1, 0, kPi / 2));
  EXPECT_EQ(graph->vertices[2].T_map_base, Pose2(1, 1, 4));
  EXPECT_EQ(graph->fixed, std::vector<std::uint32_t>{0});
  ASSERT_EQ(graph->edges.size(), 4U);
  EXPECT_EQ(graph->edges[1].i, 1U);
  EXPECT_EQ(graph->edges[1].j, 2U);
  EXPECT_EQ(graph->edges[1].T_i_j, Pose2(1, 0, 1.57));
  Eigen::Matrix3d information;
  information << 100, 1, 2, 1, 100, 3, 2, 3, 400;
  EXPECT_EQ(graph->edges[1].information, information);
  EXPECT_EQ(graph->edges[2].T_i_j, Pose2(1, 1, 3.2));
}

TEST(GoldenTexts, Toro) {
  const auto graph = read_pose_graph(golden_file("pose_graph/square.graph"));
  ASSERT_TRUE(graph.has_value()) << graph.error().to_line();
  ASSERT_EQ(graph->vertices.size(), 3U);
  EXPECT_EQ(graph->vertices[2].id, 5U);
  EXPECT_EQ(graph->vertices[2].T_map_base, Pose2(1, 0.1, 3.14));
  ASSERT_EQ(graph->edges.size(), 2U);
  EXPECT_EQ(graph->edges[1].j, 5U);
  Eigen::Matrix3d information;  // the file's order: xx xy yy tt xt yt
  information << 100, 1, 2, 1, 100, 3, 2, 3, 400;
  EXPECT_EQ(graph->edges[1].information, information);
}

GridMap read_map(const std::string& name) {
  const auto [yaml, image] = golden_parts(name);
  const ScratchFolder folder;
  write_text(folder / "a.yaml", yaml);
  write_text(folder / "101", image);
  const auto map = read_ros_map(folder / "a.yaml");
  EXPECT_TRUE(map.has_value()) << map.error().to_line();
  return map ? *map : GridMap();
}

TEST(GoldenTexts, RosMap) {
  const GridMap map = read_map("ros_map/small.yaml");
  EXPECT_EQ(map.resolution_m(), 0.05);
  EXPECT_EQ(map.origin_m(), Eigen::Vector2d(-1.5, -2));
  ASSERT_EQ(map.num_columns(), 3);
  ASSERT_EQ(map.num_rows(), 2);
  for (int row = 0; row < 2; ++row) {
    EXPECT_EQ(classify(map.at(0, row)), CellClass::kOccupied);
    EXPECT_EQ(classify(map.at(1, row)), CellClass::kFree);
    EXPECT_EQ(classify(map.at(2, row)), CellClass::kUnknown);
  }
}

// Bright is occupied; the image's first row is the map's last.
TEST(GoldenTexts, RosMapNegated) {
  const GridMap map = read_map("ros_map/block.yaml");
  EXPECT_EQ(map.resolution_m(), 1);
  ASSERT_EQ(map.num_columns(), 2);
  ASSERT_EQ(map.num_rows(), 2);
  EXPECT_EQ(classify(map.at(0, 1)), CellClass::kFree);
  EXPECT_EQ(classify(map.at(1, 1)), CellClass::kOccupied);
  EXPECT_EQ(classify(map.at(0, 0)), CellClass::kOccupied);
  EXPECT_EQ(classify(map.at(1, 0)), CellClass::kFree);
}

TEST(GoldenTexts, RobotToml) {
  const auto robot = robot_from_toml(read_text(golden_file("robot_toml/whole.toml")), "whole.toml");
  ASSERT_TRUE(robot.has_value()) << robot.error().to_line();
  EXPECT_EQ(robot->robot.name, "seed \"1\"");
  EXPECT_EQ(robot->robot.wheels.track_m, 0.35);
  EXPECT_EQ(robot->robot.wheels.left_m_per_tick, 1e-4);
  EXPECT_EQ(robot->robot.wheels.right_m_per_tick, 1e-4);
  EXPECT_EQ(robot->robot.wheels.sigma_m_per_sqrt_m, 0.01);
  EXPECT_EQ(robot->robot.lidar.T_base_lidar, Pose2(0.1, 0, kPi));
  EXPECT_EQ(robot->robot.lidar.range_min_m, 0.05);
  EXPECT_EQ(robot->robot.lidar.range_max_m, 4.5);
  EXPECT_EQ(robot->robot.lidar.range_sigma_m, 0.015);
  EXPECT_EQ(robot->robot.lidar.scan_duration_s, -0.1);
  EXPECT_EQ(robot->robot.lidar.time_offset_s, 0.02);
  EXPECT_LT(robot->robot.imu.T_base_imu.minus(Pose2(0, -0.1, -90.5 * kPi / 180)).norm(), 1e-15);
  EXPECT_EQ(robot->robot.imu.rate_hz, 100);
  EXPECT_EQ(robot->robot.imu.gyro_noise_radps, 0.01);
  EXPECT_EQ(robot->robot.imu.accel_noise_mps2, 0.05);
  EXPECT_EQ(robot->robot.imu.gyro_bias_walk_radps_sqrt_s, 1e-4);
  EXPECT_EQ(robot->robot.imu.accel_bias_walk_mps2_sqrt_s, 1e-3);
}

}  // namespace
}  // namespace corridor::formats
