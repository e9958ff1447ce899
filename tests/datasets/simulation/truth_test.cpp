#include "datasets/simulation/truth.hpp"

#include <gtest/gtest.h>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;

// As another simulator of the same suite wrote it: no list of degenerate intervals.
constexpr const char* kForeignTruth =
    "[world]\na_m = 14.500000\nb_m = 21.000000\nc_m = 5.000000\nalpha_deg = 90.0\n"
    "doors_every_m = 0\n"
    "[start]\nx_m = 2.380100\ny_m = 2.798843\nyaw_rad = -0.346314\n"
    "[wheels]\nleft_scale = 1.000012\nright_scale = 0.998519\n"
    "slips = [{ begin_s = 15.195, end_s = 16.195, ratio = 0.6 }]\n"
    "[imu]\ngyro_bias_radps = 0.004021\naccel_bias_x_mps2 = -0.01477\n"
    "accel_bias_y_mps2 = -0.01861\n"
    "[lidar]\nrange_max_m = 4.5\nrange_sigma_m = 0.015\n";

TEST(Truth, WhatIsWrittenIsReadBackToTheLastBit) {
  const ScratchFolder folder;
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor-slip"), 5);
  const auto again = read_truth(folder.write("log.truth.toml", truth_toml(simulated)));
  ASSERT_TRUE(again) << again.error().to_line();
  EXPECT_EQ(truth_toml(*again), truth_toml(simulated));
  EXPECT_EQ(again->wheels.left_scale, simulated.truth.wheels.left_scale);
  EXPECT_EQ(again->T_world_base_start, simulated.truth.T_world_base_start);
  EXPECT_EQ(again->slips.size(), 3u);
  EXPECT_EQ(again->slips[1].begin_s, simulated.truth.slips[1].begin_s);
  ASSERT_TRUE(again->degenerate);
  EXPECT_EQ(again->degenerate->size(), simulated.truth.degenerate->size());
}

TEST(Truth, NamesScansThatSeeNothingWithoutADirection) {
  const ScratchFolder folder;
  Scenario scenario;  // away from its only wall
  scenario.world = world_of({{{0, 0}, {0, 10}}});
  scenario.world.route_m = {{3, 5}, {12, 5}};
  Simulated simulated = simulated_log(scenario, 1);
  auto& intervals = *simulated.truth.degenerate;
  ASSERT_EQ(intervals.size(), 2u);
  EXPECT_TRUE(intervals[0].direction_rad);
  EXPECT_FALSE(intervals[1].direction_rad);
  const double end_s = intervals[1].end_s;
  intervals.push_back({end_s + 1, end_s + 2, 0.5});
  intervals.push_back({end_s + 3, end_s + 4, std::nullopt});
  const auto again = read_truth(folder.write("log.truth.toml", truth_toml(simulated)));
  ASSERT_TRUE(again) << again.error().to_line();
  ASSERT_EQ(again->degenerate->size(), 4u);
  EXPECT_FALSE((*again->degenerate)[1].direction_rad);
  EXPECT_EQ((*again->degenerate)[1].end_s, end_s);
  EXPECT_EQ((*again->degenerate)[2].direction_rad, 0.5);
  EXPECT_FALSE((*again->degenerate)[3].direction_rad);
}

TEST(Truth, IsTheWorldFileOfItsLog) {
  const ScratchFolder folder;
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor-vary"), 5);
  const auto world = read_world(folder.write("log.truth.toml", truth_toml(simulated)));
  ASSERT_TRUE(world) << world.error().to_line();
  EXPECT_EQ(world->corridor->b_m, simulated.truth.world.corridor->b_m);
}

TEST(Truth, OfAnotherSimulatorIsReadWithoutDegenerateIntervals) {
  const ScratchFolder folder;
  const auto truth = read_truth(folder.write("log.truth.toml", kForeignTruth));
  ASSERT_TRUE(truth) << truth.error().to_line();
  EXPECT_FALSE(truth->degenerate);
  EXPECT_EQ(truth->wheels.right_scale, 0.998519);
  EXPECT_EQ(truth->slips.size(), 1u);
  EXPECT_EQ(truth->slips[0].ratio, 0.6);
}

TEST(Truth, NamesUnknownKeysMissingTablesAndBadListsWithTheirLines) {
  const ScratchFolder folder;
  const auto truth = read_truth(folder.write("log.truth.toml",
                                             "[world]\na_m = 1\nb_m = 1\nc_m = 1\n"
                                             "alpha_deg = 90\ndoors_every_m = 0\nd_m = 3\n"
                                             "[wheels]\nleft_scale = 1\nright_scale = 1\n"
                                             "slips = [{ begin_s = 1, end_s = 2 }]\n"
                                             "[imu]\ngyro_bias_radps = 0\n"
                                             "accel_bias_x_mps2 = 0\naccel_bias_y_mps2 = 0\n"
                                             "[lidar]\nrange_max_m = 4\nrange_sigma_m = 0\n"));
  ASSERT_FALSE(truth);
  const std::string error = truth.error().to_line();
  EXPECT_NE(error.find(":7: unknown key world.d_m"), std::string::npos) << error;
  EXPECT_NE(error.find(":11: wheels.slips.ratio is missing"), std::string::npos) << error;
  EXPECT_NE(error.find("no table [start]"), std::string::npos) << error;
}

TEST(Truth, RefusesNumbersThatAreNotFinite) {
  const ScratchFolder folder;
  for (const std::string number : {"nan", "inf", "-inf"}) {
    for (const char* key : {"x_m = 2.380100", "begin_s = 15.195", "range_max_m = 4.5"}) {
      std::string text = kForeignTruth;
      const std::string name(key, std::string_view(key).find(' '));
      text.replace(text.find(key), std::string_view(key).size(), name + " = " + number);
      const auto truth = read_truth(folder.write("log.truth.toml", text));
      ASSERT_FALSE(truth) << text;
      EXPECT_NE(truth.error().to_line().find(name + " is not finite"), std::string::npos)
          << truth.error().to_line();
    }
  }
}

TEST(Truth, RicherErrorsAndGripSlipsAreReadBack) {
  const ScratchFolder folder;
  Scenario scenario = shipped_scenario("paper-corridor-real");
  scenario.drive.acceleration_mps2 = 1.5;
  scenario.drive.friction_limit_mps2 = 0.3;
  scenario.slip.num_slips = 2;
  scenario.imu.time_offset_sigma_s = 0.01;
  const Simulated simulated = simulated_log(scenario, 5);
  const auto again = read_truth(folder.write("log.truth.toml", truth_toml(simulated)));
  ASSERT_TRUE(again) << again.error().to_line();
  EXPECT_EQ(truth_toml(*again), truth_toml(simulated));
  EXPECT_EQ(again->imu.misalignment_rad, simulated.truth.imu.misalignment_rad);
  EXPECT_EQ(again->wheels.track_ratio, simulated.truth.wheels.track_ratio);
  EXPECT_EQ(again->lidar_time_offset_s, simulated.truth.lidar_time_offset_s);
  EXPECT_EQ(again->imu_time_offset_s, simulated.truth.imu_time_offset_s);
  ASSERT_EQ(again->imu_bias.size(), static_cast<std::size_t>(simulated.log.duration_s()));
  EXPECT_EQ(again->imu_bias.back().stamp_s, static_cast<double>(again->imu_bias.size()));
  EXPECT_EQ(again->imu_bias.back().bias.accel_y_mps2,
            simulated.truth.imu_bias.back().bias.accel_y_mps2);
  EXPECT_NE(again->imu_bias.back().bias.gyro_radps, again->imu_bias.front().bias.gyro_radps);
  ASSERT_EQ(again->slips.size(), simulated.truth.slips.size());
  ASSERT_GT(again->slips.size(), 2u);
  for (std::size_t i = 0; i < again->slips.size(); ++i) {
    EXPECT_EQ(again->slips[i].cause, simulated.truth.slips[i].cause);
    EXPECT_EQ(again->slips[i].begin_s, simulated.truth.slips[i].begin_s);
  }
}

TEST(Truth, CarriesADrawnWorld) {
  const ScratchFolder folder;
  const Simulated simulated = simulated_log(shipped_scenario("clutter"), 1);
  const auto again = read_truth(folder.write("log.truth.toml", truth_toml(simulated)));
  ASSERT_TRUE(again) << again.error().to_line();
  EXPECT_EQ(again->world.walls.size(), simulated.world.walls.size());
  EXPECT_EQ(again->world.arcs.size(), 2u);
  EXPECT_EQ(again->world.material_of_surface, simulated.world.material_of_surface);
  EXPECT_EQ(again->world.route_m, simulated.world.route_m);
}

}  // namespace
}  // namespace corridor::simulation::testing
