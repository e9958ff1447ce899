#include "bench/metrics/key_distances.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/bench/metrics/test_corridor.hpp"

namespace corridor::metrics {
namespace {

constexpr double kClose_m = 0.005;
constexpr double kClose_deg = 0.1;

struct Surveyed {
  simulation::CorridorShape shape;
  simulation::World world = simulation::make_corridor(shape);
  Trajectory truth = drive(shape, 0.05);
  std::vector<LaserScan> scans;

  explicit Surveyed(std::uint64_t seed, const simulation::CorridorShape& corridor_shape = {})
      : shape(corridor_shape) {
    Rng rng(seed);
    scans = take_scans(world, truth, rng);
  }

  [[nodiscard]] results::KeyDistances measure(const Trajectory& estimate) const {
    return measure_key_distances(map_at(scans, estimate), estimate, truth, world, kTestRange_m);
  }
};

void expect_exact(const results::KeyDistances& measured) {
  for (const auto* distance : {&measured.a, &measured.b, &measured.c}) {
    ASSERT_EQ(distance->status, "ok");
    EXPECT_LT(std::abs(*distance->error_m), kClose_m);
    EXPECT_NEAR(*distance->measured_m - *distance->true_m, *distance->error_m, 1e-12);
    EXPECT_GT(*distance->sigma_m, 0);
    EXPECT_LT(*distance->sigma_m, 0.01);
  }
  ASSERT_EQ(measured.alpha.status, "ok");
  EXPECT_LT(std::abs(*measured.alpha.error_deg), kClose_deg);
}

TEST(KeyDistances, OfAnExactMapAreTheTrueOnes) {
  const Surveyed corridor(1);
  for (const Pose2& T_map_world :
       {Pose2(), Pose2(0.0125, 0.02, 0), Pose2(-2.5, -2.4, 0.3), Pose2(1, 2, 2.5)}) {
    const auto measured = corridor.measure(in_frame(corridor.truth, T_map_world));
    EXPECT_EQ(measured.a.true_m, 14.5);
    EXPECT_EQ(measured.b.true_m, 21.0);
    EXPECT_EQ(measured.c.true_m, 5.0);
    EXPECT_NEAR(*measured.alpha.true_deg, 90, 1e-12);
    expect_exact(measured);
  }
}

TEST(KeyDistances, OfOtherShapesAreTheTrueOnes) {
  expect_exact(Surveyed(2, {.a_m = 12, .b_m = 18, .c_m = 4, .alpha_rad = 1.9})
                   .measure(drive({.a_m = 12, .b_m = 18, .c_m = 4, .alpha_rad = 1.9}, 0.05)));
  expect_exact(Surveyed(3, {.alpha_rad = 1.3}).measure(drive({.alpha_rad = 1.3}, 0.05)));
}

TEST(KeyDistances, AreNotFooledByDoorRecesses) {
  const Surveyed corridor(4, {.doors_every_m = 3.4});
  expect_exact(corridor.measure(in_frame(corridor.truth, Pose2(1, 2, 0.2))));
}

// A metre goes missing in the middle of an arm, as scan matching loses it where nothing is seen
// along it.
TEST(KeyDistances, OfAShrunkArmAreMeasuredAsShrunk) {
  const Surveyed corridor(5);
  const auto lost_m = [](double along_m) { return std::clamp((along_m - 8) / 6, 0.0, 1.0); };
  const Pose2 T_map_world(-2, 1, 0.2);
  auto measured = corridor.measure(changed(corridor.truth, [&](std::size_t, const Pose2& pose) {
    return T_map_world * Pose2(pose.x_m() - lost_m(pose.x_m()), pose.y_m(), pose.theta_rad());
  }));
  EXPECT_NEAR(*measured.b.error_m, -1, kClose_m);
  EXPECT_NEAR(*measured.a.error_m, 0, kClose_m);
  EXPECT_NEAR(*measured.c.error_m, 0, kClose_m);
  EXPECT_NEAR(*measured.alpha.error_deg, 0, kClose_deg);

  const auto lost_above_m = [](double y_m) { return std::clamp((y_m - 6) / 4, 0.0, 1.0); };
  measured = corridor.measure(changed(corridor.truth, [&](std::size_t, const Pose2& pose) {
    return Pose2(pose.x_m(), pose.y_m() - lost_above_m(pose.y_m()), pose.theta_rad());
  }));
  EXPECT_NEAR(*measured.a.error_m, -1, kClose_m);
  EXPECT_NEAR(*measured.b.error_m, 0, kClose_m);
}

// The robot believes to have turned 88 deg at the corner: the second arm hangs over.
TEST(KeyDistances, OfABentCornerAreMeasuredAsBent) {
  const Surveyed corridor(6);
  const Pose2 T_world_pivot(18.5, 2.5, 0);
  const double missing_rad = 2 * std::numbers::pi / 180;
  const auto measured =
      corridor.measure(changed(corridor.truth, [&](std::size_t, const Pose2& pose) {
        const double turned = std::clamp(pose.theta_rad() / (std::numbers::pi / 2), 0.0, 1.0);
        return T_world_pivot * Pose2(0, 0, -missing_rad * turned) * T_world_pivot.inverse() * pose;
      }));
  // The right outer wall turns clockwise by 2 deg, away from the lower one.
  EXPECT_NEAR(*measured.alpha.error_deg, 2, 0.2);
}

struct Calibration {
  double mean_squared_z = 0;  // of a, b, c and alpha; 1 if the sigmas are right
  double ratio_within_2_sigma = 0;
};

// Maps of a drive in frames within +-20 deg, at poses with noise.
Calibration calibrate(int num_maps, double sigma_m, double sigma_rad) {
  Calibration calibration;
  const simulation::CorridorShape shape;
  const simulation::World world = simulation::make_corridor(shape);
  const Trajectory truth = drive(shape, 0.1);
  for (int i = 0; i < num_maps; ++i) {
    Rng rng(100 + static_cast<std::uint64_t>(i));
    const auto scans = take_scans(world, truth, rng);
    const Pose2 T_map_world(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.35, 0.35));
    const Trajectory estimate = changed(truth, [&](std::size_t, const Pose2& pose) {
      return (T_map_world * pose)
          .plus({rng.normal(0, sigma_m), rng.normal(0, sigma_m), rng.normal(0, sigma_rad)});
    });
    const auto measured =
        measure_key_distances(map_at(scans, estimate), estimate, truth, world, kTestRange_m);
    for (const double z : {measured.a.error_m.value() / measured.a.sigma_m.value(),
                           measured.b.error_m.value() / measured.b.sigma_m.value(),
                           measured.c.error_m.value() / measured.c.sigma_m.value(),
                           measured.alpha.error_deg.value() / measured.alpha.sigma_deg.value()}) {
      calibration.mean_squared_z += z * z / (4 * num_maps);
      if (std::abs(z) < 2) calibration.ratio_within_2_sigma += 1.0 / (4 * num_maps);
    }
  }
  return calibration;
}

TEST(KeyDistances, ErrorsAreAsLargeAsTheirSigmas) {
  const auto calibration = calibrate(15, 0, 0);
  EXPECT_GT(calibration.mean_squared_z, 0.4);
  EXPECT_LT(calibration.mean_squared_z, 1.5);
  EXPECT_GE(calibration.ratio_within_2_sigma, 0.9);
}

// Noise that is new in every scan averages out better than the sigmas, made for drift, assume.
TEST(KeyDistances, ErrorsOfNoisyPosesAreNotLargerThanTheirSigmas) {
  const auto calibration = calibrate(8, 0.01, 0.002);
  EXPECT_GT(calibration.mean_squared_z, 0.02);
  EXPECT_LT(calibration.mean_squared_z, 1);
  EXPECT_GE(calibration.ratio_within_2_sigma, 0.95);
}

TEST(KeyDistances, OfADoubledWallAreDoubtful) {
  const Surveyed corridor(7);
  for (const double gap_m : {0.1, 0.2, 0.4, 1.0}) {
    const auto measured =
        corridor.measure(changed(corridor.truth, [&](std::size_t i, const Pose2& pose) {
          return Pose2(pose.x_m(), pose.y_m() + (i % 2 == 0 ? gap_m : 0), pose.theta_rad());
        }));
    const bool is_refused =
        !measured.a.measured_m && measured.a.status.starts_with("not measurable");
    EXPECT_TRUE(is_refused || *measured.a.sigma_m > 0.2 * gap_m)
        << gap_m << " " << measured.a.sigma_m.value_or(0);
  }
}

TEST(KeyDistances, OfAMapWithoutHitCountsAreLessCertain) {
  const Surveyed corridor(8);
  const Trajectory estimate = in_frame(corridor.truth, Pose2(0, 0, 0.2));
  GridMap map = map_at(corridor.scans, estimate);
  const auto with_hits =
      measure_key_distances(map, estimate, corridor.truth, corridor.world, kTestRange_m);
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) map.at(column, row).hits = 0;
  }
  const auto without =
      measure_key_distances(map, estimate, corridor.truth, corridor.world, kTestRange_m);
  ASSERT_EQ(without.b.status, "ok");
  EXPECT_LT(std::abs(*without.b.error_m), 0.03);
  EXPECT_LT(std::abs(*without.b.error_m), 3 * *without.b.sigma_m);
  EXPECT_GT(*without.b.sigma_m, 1.2 * *with_hits.b.sigma_m);
}

void expect_none(const results::KeyDistances& measured, const std::string& why) {
  for (const auto* distance : {&measured.a, &measured.b, &measured.c}) {
    EXPECT_FALSE(distance->measured_m || distance->error_m || distance->sigma_m);
    EXPECT_NE(distance->status.find(why), std::string::npos) << distance->status;
  }
  EXPECT_FALSE(measured.alpha.measured_deg || measured.alpha.error_deg || measured.alpha.sigma_deg);
  EXPECT_NE(measured.alpha.status.find(why), std::string::npos);
}

TEST(KeyDistances, OfNothingAreNotMeasurableAndSayWhy) {
  const Surveyed corridor(9);
  const GridMap map = map_at(corridor.scans, corridor.truth);
  expect_none(measure_key_distances({}, corridor.truth, corridor.truth, corridor.world, 4.5),
              "the map is empty");
  expect_none(measure_key_distances(map, {}, corridor.truth, corridor.world, 4.5),
              "no estimated pose has a true one");
  expect_none(measure_key_distances(map, corridor.truth, corridor.truth, corridor.world, 0.1),
              "no wall was seen");
  expect_none(measure_key_distances(map, corridor.truth, corridor.truth, {}, 4.5),
              "the world has no corridor");
  expect_none(measure_key_distances(GridMap(0.05, {0, 0}, 100, 100), corridor.truth, corridor.truth,
                                    corridor.world, 4.5),
              "holds nothing where the walls are expected");
}

TEST(KeyDistances, OfAnUnfinishedDriveMissOnlyWhatWasNotSeen) {
  const Surveyed corridor(10);
  Trajectory estimate;
  for (const auto& pose : corridor.truth.poses()) {
    if (pose.T_map_base.x_m() < 12 && !estimate.append(pose)) FAIL();
  }
  const auto measured = corridor.measure(estimate);
  EXPECT_EQ(measured.c.status, "ok");
  EXPECT_EQ(measured.a.status, "not measurable: right_outer: the wall was not seen");
  EXPECT_EQ(measured.b.status, "not measurable: right_outer: the wall was not seen");
}

TEST(KeyDistances, OfGarbageMapsAreNeverNotANumber) {
  const Surveyed corridor(11);
  Rng rng(1);
  for (int trial = 0; trial < 5; ++trial) {
    GridMap map(0.1, {-1, -1}, 240, 180);
    for (int row = 0; row < map.num_rows(); ++row) {
      for (int column = 0; column < map.num_columns(); ++column) {
        if (rng.uniform() < 0.2) map.at(column, row).hits = static_cast<float>(rng.below(50));
        if (rng.uniform() < 0.001) map.at(column, row).hits = std::nanf("");
      }
    }
    const auto measured =
        measure_key_distances(map, corridor.truth, corridor.truth, corridor.world, kTestRange_m);
    for (const auto* distance : {&measured.a, &measured.b, &measured.c}) {
      if (distance->measured_m) {
        EXPECT_TRUE(std::isfinite(*distance->measured_m) && std::isfinite(*distance->sigma_m));
      }
      EXPECT_FALSE(distance->status.empty());
    }
  }
}

}  // namespace
}  // namespace corridor::metrics
