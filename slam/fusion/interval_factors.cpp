#include "slam/fusion/interval_factors.hpp"

#include <algorithm>
#include <cmath>

#include "slam/fusion/calibration.hpp"
#include "slam/fusion/submap.hpp"
#include "slam/graph/factors/motion_factors.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::fusion {
namespace {

using graph::NewFactor;

// How much worse than nominal a sensor is taken that was excluded and came back as the least bad
// one.
constexpr double kLeastBadFactor = 10;
// The pose of key scan 0 defines the map frame.
constexpr double kGaugeSigma = 1e-4;
// Where neither wheels nor IMU nor the whole LiDAR measured an interval.
constexpr double kTrackedSigma_m = 0.2;
constexpr double kTrackedSigma_rad = 0.2;
// The paper's test compares scans about a travel apart; a key scan comes a little before it.
constexpr double kNearlyThere = 0.9;
// A view that does not change at all is this bad at most.
constexpr double kLeastDifference_m = 1e-6;

struct LidarChoice {
  double sigma_factor = 1;  // on the constant noise of the paper's constraint
  double badness = 0;       // >= 1: degraded
};

// The paper's scalar test: too small a change of the view while the wheels moved.
LidarChoice scalar_lidar_test(const Interval& interval, const RobotModel& robot,
                              const FusionParams& params) {
  LidarChoice choice;
  const bool has_moved = interval.wheels && interval.wheels->raw_T_i_j().translation_m().norm() >=
                                                kNearlyThere * params.degeneracy_travel_m;
  if (!interval.range_difference_m || !has_moved) return choice;
  const double threshold_m =
      params.degeneracy_floor_factor * range_difference_floor_m(robot.lidar.range_sigma_m);
  choice.badness = threshold_m / std::max(*interval.range_difference_m, kLeastDifference_m);
  choice.sigma_factor = adaptive_factor(choice.badness);
  return choice;
}

graph::RelativePose scalar_lidar_factor(const Interval& interval, double sigma_factor,
                                        const FusionParams& params) {
  const double translation = 1 / (params.lidar_sigma_m * sigma_factor);
  const double rotation = 1 / (params.lidar_sigma_rad * sigma_factor);
  return graph::RelativePose(graph::pose_key(interval.submap_frame), graph::pose_key(interval.j),
                             interval.match->T_map_base,
                             Eigen::Vector3d(translation, translation, rotation).asDiagonal());
}

graph::RelativePose tracked_factor(const Interval& interval) {
  const Eigen::Vector3d weight(1 / kTrackedSigma_m, 1 / kTrackedSigma_m, 1 / kTrackedSigma_rad);
  return graph::RelativePose(graph::pose_key(interval.i), graph::pose_key(interval.j),
                             interval.tracked_T_i_j, weight.asDiagonal().toDenseMatrix());
}

graph::WheelMotion wheel_factor(const Interval& interval, const WheelNoise& noise,
                                double sigma_factor, const FusionParams& params) {
  Eigen::Vector3d weight(1 / (noise.translation_sigma_m * sigma_factor),
                         1 / (noise.translation_sigma_m * sigma_factor),
                         1 / (noise.rotation_sigma_rad * sigma_factor));
  // The gyro knows the turn better than wheels of which nobody knows how unequal they are.
  if (!params.use_wheel_turn && interval.imu && interval.imu->unmeasured_s == 0) weight(2) = 0;
  return graph::WheelMotion(graph::pose_key(interval.i), graph::pose_key(interval.j),
                            graph::wheel_calibration_key(interval.calibration), *interval.wheels,
                            weight.asDiagonal());
}

void add_imu_factors(const Interval& interval, const ImuModel& imu,
                     std::vector<NewFactor>& factors) {
  factors.push_back(graph::ImuMotion(interval.i, interval.j, *interval.imu));
  factors.push_back(
      graph::BiasWalk(interval.i, interval.j, imu_bias_walk(imu, interval.imu->duration_s)));
}

SlipTest slip_of(const Interval& interval, const WheelNoise& noise, const RobotModel& robot,
                 const FusionParams& params) {
  if (!interval.wheels || !interval.imu || interval.imu->unmeasured_s > 0) return {};
  return test_slip(interval.wheels->base_motion(interval.wheel_calibration), noise, *interval.imu,
                   interval.velocity_base_i_mps, interval.velocity_sigma_mps, interval.anchor_age_s,
                   robot.imu, params);
}

// The published method: each sensor in or out as a whole.
IntervalVerdict add_scalar_factors(const Interval& interval, const WheelNoise& noise,
                                   const SlipTest& slip, const RobotModel& robot,
                                   const FusionParams& params, std::vector<NewFactor>& factors) {
  const LidarChoice lidar = scalar_lidar_test(interval, robot, params);
  IntervalVerdict verdict;
  verdict.is_slip = slip.is_slip;
  verdict.is_degenerate = lidar.badness >= 1;
  verdict.are_wheels_used = interval.wheels && !verdict.is_slip;
  verdict.is_lidar_used = interval.match && !verdict.is_degenerate;
  double wheel_factor_on_sigma = adaptive_factor(slip.measure_over_threshold);
  double lidar_factor_on_sigma = lidar.sigma_factor;
  if (!verdict.are_wheels_used && !verdict.is_lidar_used) {
    verdict.is_least_bad_kept = true;
    verdict.are_wheels_used =
        interval.wheels && (!interval.match || slip.measure_over_threshold < lidar.badness);
    verdict.is_lidar_used = interval.match && !verdict.are_wheels_used;
    wheel_factor_on_sigma *= kLeastBadFactor;
    lidar_factor_on_sigma *= kLeastBadFactor;
  }
  if (verdict.are_wheels_used) {
    factors.push_back(wheel_factor(interval, noise, wheel_factor_on_sigma, params));
  }
  if (verdict.is_lidar_used) {
    verdict.lidar_factor = factors.size();
    factors.push_back(scalar_lidar_factor(interval, lidar_factor_on_sigma, params));
  }
  return verdict;
}

// Ours: the LiDAR enters along the directions it sees, the wheels unless a test says no.
IntervalVerdict add_directional_factors(const Interval& interval, const WheelNoise& noise,
                                        const SlipTest& slip, double wheel_noise_factor,
                                        const FusionParams& params,
                                        std::vector<NewFactor>& factors) {
  IntervalVerdict verdict;
  verdict.is_slip = slip.is_slip || interval.is_wheel_jump;
  const int num_observable = interval.match ? interval.match->num_observable : 0;
  verdict.is_degenerate = num_observable < 3;
  verdict.is_lidar_used = num_observable > 0;
  verdict.are_wheels_used = interval.wheels && !verdict.is_slip;
  double sigma_factor = wheel_noise_factor;
  if (interval.wheels && !verdict.are_wheels_used && verdict.is_degenerate && !interval.imu) {
    verdict.is_least_bad_kept = verdict.are_wheels_used = true;
    sigma_factor *= kLeastBadFactor;
  }
  if (verdict.are_wheels_used) {
    factors.push_back(wheel_factor(interval, noise, sigma_factor, params));
  }
  if (verdict.is_lidar_used) {
    verdict.lidar_factor = factors.size();
    factors.push_back(place_factor(interval.submap_frame, interval.j, interval.match->T_map_base,
                                   interval.match->information));
  }
  return verdict;
}

}  // namespace

IntervalVerdict add_interval_factors(const Interval& interval, const RobotModel& robot,
                                     double wheel_noise_factor, const FusionParams& params,
                                     std::vector<NewFactor>& factors) {
  if (interval.imu) add_imu_factors(interval, robot.imu, factors);
  const WheelNoise noise =
      interval.wheels ? nominal_wheel_noise(interval.wheels->raw_T_i_j(), robot.wheels, params)
                      : WheelNoise{};
  const SlipTest slip = slip_of(interval, noise, robot, params);
  const IntervalVerdict verdict =
      params.use_directional_degeneracy
          ? add_directional_factors(interval, noise, slip, wheel_noise_factor, params, factors)
          : add_scalar_factors(interval, noise, slip, robot, params, factors);
  // Nothing else ties the new state: hold it loosely where it was tracked.
  const bool is_lidar_whole = verdict.is_lidar_used && !verdict.is_degenerate;
  if (!interval.imu && !verdict.are_wheels_used && !is_lidar_whole) {
    factors.push_back(tracked_factor(interval));
  }
  return verdict;
}

void add_first_factors(const FusionParams& params, std::vector<NewFactor>& factors) {
  factors.push_back(
      graph::PosePrior(graph::pose_key(0), Pose2(), Eigen::Matrix3d::Identity() / kGaugeSigma));
  factors.push_back(graph::WheelCalibrationPrior(0, motion::WheelCalibration::Zero(),
                                                 wheel_calibration_sigma(params)));
}

void add_imu_priors(std::uint32_t key, const FusionParams& params,
                    std::vector<NewFactor>& factors) {
  factors.push_back(graph::VelocityPrior(
      key, Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(params.initial_velocity_sigma_mps)));
  factors.push_back(graph::BiasPrior(key, motion::ImuBias::Zero(), imu_bias_sigma(params)));
}

}  // namespace corridor::fusion
