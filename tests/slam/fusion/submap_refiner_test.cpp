#include "slam/fusion/submap_refiner.hpp"

#include <gtest/gtest.h>

#include "tests/slam/fusion/drive.hpp"

namespace corridor::fusion {
namespace {

FusionParams four_scans() {
  FusionParams params;
  params.submap_key_scans = 4;
  return params;
}

// Seven key scans: two submaps of four are finished, the third has three scans.
class SubmapRefinerTest : public ::testing::Test {
 protected:
  SubmapRefinerTest() {
    for (int i = 0; i < 7; ++i) drive_.add(truth(i), 0.25 * i);
  }
  static Pose2 truth(int i) { return {0.25 * i - 1, 0, 0}; }

  // What a place says of scan `key`, in the map.
  Pose2 placed(const RefinedPlace& place) const {
    const auto& factor = std::get<graph::RelativePose>(place.factor.factor);
    return drive_.values.pose(factor.keys()[0].index) * factor.measured_T_i_j();
  }
  static std::uint32_t key_of(const RefinedPlace& place) {
    return std::get<graph::RelativePose>(place.factor.factor).keys()[1].index;
  }

  const RobotModel robot_;
  Drive drive_{four_scans()};
  SubmapRefiner refiner_{robot_, drive_.params};
};

TEST_F(SubmapRefinerTest, FindsEachScanOfAFinishedSubmapWhereItIsWhateverTheEstimateSays) {
  ASSERT_EQ(drive_.map.finished().size(), 2u);
  for (std::uint32_t key = 1; key < 4; ++key) {
    drive_.values.set_pose(key, truth(static_cast<int>(key)).plus({0.02, -0.02, 0.01}));
  }
  const auto places = refiner_.next(4, drive_.key_scans, drive_.map, drive_.values);
  ASSERT_EQ(places.size(), 4u);
  for (const RefinedPlace& place : places) {
    const Pose2 error = truth(static_cast<int>(key_of(place))).between(placed(place));
    EXPECT_LT(error.translation_m().norm(), 0.01) << key_of(place);
    EXPECT_LT(std::abs(error.theta_rad()), 0.004) << key_of(place);
  }
}

TEST_F(SubmapRefinerTest, TakesEveryScanOfEveryFinishedSubmapOnce) {
  std::vector<std::uint32_t> keys;
  for (int i = 0; i < 10; ++i) {
    for (const auto& place : refiner_.next(3, drive_.key_scans, drive_.map, drive_.values)) {
      keys.push_back(key_of(place));
    }
  }
  EXPECT_EQ(keys, (std::vector<std::uint32_t>{0, 1, 2, 3, 2, 3, 4, 5}));
  EXPECT_EQ(refiner_.num_done(), 2u);
}

TEST_F(SubmapRefinerTest, ReplacesTheFactorThatSaidTheSameAndAddsWhereThereWasNone) {
  drive_.map.finished()[0]->set_factor(2, 17, 3);
  const auto places = refiner_.next(4, drive_.key_scans, drive_.map, drive_.values);
  for (const RefinedPlace& place : places) {
    EXPECT_EQ(place.replaced,
              key_of(place) == 2 ? std::optional<graph::FactorId>(17) : std::nullopt);
  }
}

TEST_F(SubmapRefinerTest, LeavesScansAloneThatWereOutvoted) {
  drive_.key_scans[2].is_trusted = false;
  for (const auto& place : refiner_.next(4, drive_.key_scans, drive_.map, drive_.values)) {
    EXPECT_NE(key_of(place), 2u);
  }
}

TEST_F(SubmapRefinerTest, WhatIsLeftIsTheActiveSubmapAndNoneThatHasHardlyBegun) {
  (void)refiner_.next(100, drive_.key_scans, drive_.map, drive_.values);
  std::vector<std::uint32_t> keys;
  for (const auto& place : refiner_.rest(drive_.key_scans, drive_.map, drive_.values)) {
    keys.push_back(key_of(place));
  }
  EXPECT_EQ(keys, (std::vector<std::uint32_t>{4, 5, 6}));
}

TEST(FrameFactor, HoldsEveryDirectionThoseThatTheScanDoesNotSeeTightest) {
  // Along two walls a scan sees nothing.
  Drive drive{four_scans()};
  const RobotModel robot;
  Rng rng(3);
  KeyScan scan;
  scan.points_base_m =
      testing::points_of(testing::scan_of(testing::corridor_walls(), {}, 4.5, 0.01, rng));
  Submap submap(1000, drive.params);
  submap.insert(0, {}, scan.points_base_m);
  const graph::NewFactor factor = frame_factor(submap, scan, robot, drive.params);
  const Eigen::Matrix3d information = std::get<graph::RelativePose>(factor.factor).information();
  const double floor_m = drive.params.observability.translation_floor_m;
  EXPECT_NEAR(1 / std::sqrt(information(0, 0)), 0.1 * floor_m, 0.02 * floor_m);
  EXPECT_GT(1 / std::sqrt(information(1, 1)), floor_m);
}

}  // namespace
}  // namespace corridor::fusion
