// Watches the sensors: slip of the wheels, degeneracy of the LiDAR, and how good the wheels are on
// the whole. The paper's tests (section 2, "sensor uncertainty detection") and their statistical
// versions.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/core/robot_model.hpp"
#include "slam/core/scan.hpp"
#include "slam/fusion/fusion_params.hpp"
#include "slam/motion/imu_preintegration.hpp"

namespace corridor::fusion {

struct WheelNoise {
  double translation_sigma_m = 0;
  double rotation_sigma_rad = 0;

  // 3x3, order (x_m, y_m, theta_rad).
  [[nodiscard]] Eigen::Matrix3d covariance() const;
};

// What one wheel displacement is worth before any adaptation: random error of the robot model,
// errors proportional to path and turn, and floors.
WheelNoise nominal_wheel_noise(const Pose2& wheel_T_i_j, const WheelModel& model,
                               const FusionParams& params);

// The paper's weight: factor >= 1 on a standard deviation from how near a measure comes to its
// threshold: 1 + (measure / threshold)^2, so 1 far on the good side and 2 at the threshold.
double adaptive_factor(double measure_over_threshold);

// Mean absolute difference of the ranges valid in both scans after turning the earlier one by
// `turn_rad` to whole beams [m]; nullopt with fewer than ten such beams.
std::optional<double> mean_range_difference_m(const LaserScan& earlier, const LaserScan& later,
                                              double turn_rad);

// Expectation of that difference for an unchanged view: E|a - b| = 2 sigma / sqrt(pi).
double range_difference_floor_m(double range_sigma_m);

// Of each component of the estimated velocity: since wheels or LiDAR last fixed it, anchor_age_s
// ago, it has walked with the accelerometer's noise and bias error.
double velocity_variance_m2ps2(double velocity_sigma_mps, double anchor_age_s,
                               const ImuModel& imu_model, const FusionParams& params);

struct SlipTest {
  double measure_over_threshold = 0;
  bool is_slip = false;
};

// Wheels against the IMU over one key interval. velocity_base: estimated velocity at its begin,
// with its standard deviation, in the base frame; anchor_age_s: time since wheels or LiDAR last
// fixed it along the motion.
SlipTest test_slip(const Pose2& scaled_wheel_T_i_j, const WheelNoise& noise,
                   const motion::ImuDelta& imu, const Eigen::Vector2d& velocity_base_mps,
                   double velocity_sigma_mps, double anchor_age_s, const ImuModel& imu_model,
                   const FusionParams& params);

// Follows how far the wheels are from what the LiDAR measures and scales their noise accordingly.
class WheelNoiseAdapter {
 public:
  explicit WheelNoiseAdapter(double max_factor) : max_factor_(max_factor) {}

  // normalized_square: innovation^T S^-1 innovation over its degrees of freedom, S with the present
  // factor.
  void observe(double normalized_square);
  [[nodiscard]] double factor() const;

 private:
  double max_factor_;
  double mean_square_ = 1;
};

}  // namespace corridor::fusion
