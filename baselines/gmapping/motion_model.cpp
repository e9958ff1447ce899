#include "baselines/gmapping/motion_model.hpp"

#include <cmath>

namespace corridor::gmapping {
namespace {

// Sideways noise per forward motion, as a share of the forward noise; fixed in the original.
constexpr double kSidewaysShare = 0.3;

}  // namespace

void MotionNoise::add(const MotionNoise& step) {
  x_m = std::hypot(x_m, step.x_m);
  y_m = std::hypot(y_m, step.y_m);
  theta_rad = std::hypot(theta_rad, step.theta_rad);
}

MotionNoise motion_noise(const Pose2& T_before_after, const GmappingParams& params) {
  const double dx_m = std::abs(T_before_after.x_m());
  const double dy_m = std::abs(T_before_after.y_m());
  const double dtheta_rad = std::abs(T_before_after.theta_rad());
  const double along = params.translation_noise_per_m;
  const double across = kSidewaysShare * along;
  const double by_rotation_m = params.translation_noise_m_per_rad * dtheta_rad;
  return {.x_m = along * dx_m + by_rotation_m + across * dy_m,
          .y_m = along * dy_m + by_rotation_m + across * dx_m,
          .theta_rad = params.rotation_noise_per_rad * dtheta_rad +
                       params.rotation_noise_rad_per_m * std::hypot(dx_m, dy_m)};
}

Pose2 sample_motion(const Pose2& T_map_base, const Pose2& T_before_after, const MotionNoise& noise,
                    Rng& rng) {
  const double dx_m = rng.normal(T_before_after.x_m(), noise.x_m);
  const double dy_m = rng.normal(T_before_after.y_m(), noise.y_m);
  const double dtheta_rad = rng.normal(T_before_after.theta_rad(), noise.theta_rad);
  return T_map_base * Pose2(dx_m, dy_m, dtheta_rad);
}

}  // namespace corridor::gmapping
