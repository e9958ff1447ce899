#include "slam/motion/gyro_odometry.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor::motion {
namespace {

constexpr double kBias_radps = 0.006;

// Two seconds at rest, then a bend of 0.5 m/s and 0.3 rad/s. Wheels at 50 Hz whose turn is off by
// `unbalance_radpm` of their path, a gyro at 200 Hz with bias and noise.
struct Drive {
  GyroOdometry filter{RobotModel{}};
  Pose2 truth, by_wheels, by_filter;

  Drive(double unbalance_radpm, double duration_s, std::uint64_t seed, bool has_gyro = true) {
    Rng rng(seed);
    const RobotModel robot;
    for (int k = 0; k <= static_cast<int>(duration_s * 200); ++k) {
      const Timestamp stamp = timestamp_from_seconds(k / 200.0);
      const bool is_moving = k > 400;
      const double rate_radps = is_moving ? 0.3 : 0;
      if (is_moving) {
        truth = truth * Pose2::exp({0.5 / 200, 0, rate_radps / 200});
        by_wheels =
            by_wheels * Pose2::exp({0.5 / 200, 0, (rate_radps + 0.5 * unbalance_radpm) / 200});
      }
      if (k % 4 == 0) by_filter = filter.corrected({stamp, by_wheels, {}}).T_odom_base;
      const double read_radps =
          rate_radps + kBias_radps + rng.normal(0, robot.imu.gyro_noise_radps);
      if (has_gyro) filter.add(ImuSample{stamp, read_radps, 0, 0});
    }
  }
};

TEST(GyroOdometry, LearnsTheBiasAtRestAndFollowsTheGyroWhereTheWheelsAreUnequal) {
  const Drive drive(0.02, 22, 1);
  EXPECT_NEAR(drive.filter.bias_radps(), kBias_radps, 4 * std::sqrt(drive.filter.bias_variance()));
  const double wheel_error_rad = drive.truth.between(drive.by_wheels).theta_rad();
  EXPECT_NEAR(wheel_error_rad, 0.2, 0.01);
  EXPECT_LT(std::abs(drive.truth.between(drive.by_filter).theta_rad()), 0.05);
}

TEST(GyroOdometry, WithoutAGyroIsTheWheelsOdometry) {
  const Drive drive(0.02, 12, 1, false);
  EXPECT_LT(drive.by_wheels.minus(drive.by_filter).norm(), 1e-9);
}

// What is added up is the filtered turn of each step; the path stays the wheels'.
RC_GTEST_PROP(GyroOdometry, GoesAsFarAsTheWheelsWhateverTheirTurnIsOff, (std::uint64_t seed)) {
  const double unbalance_radpm = Rng(seed).uniform(-0.05, 0.05);
  const Drive drive(unbalance_radpm, 6, seed);
  RC_ASSERT((drive.truth.translation_m() - drive.by_filter.translation_m()).norm() < 0.06);
}

}  // namespace
}  // namespace corridor::motion
