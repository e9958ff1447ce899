// The name of a variable in a factor graph.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace corridor::graph {

// What a variable is; it fixes the variable's dimension.
enum class VariableKind : std::uint32_t {
  kPose,      // SE(2), T_map_base; tangent order (x_m, y_m, theta_rad) in base
  kVelocity,  // R^2 [m/s], of the base in the map frame
  kBias,      // R^4, order (gyro z [rad/s], accelerometer x, y [m/s^2], gyro scale error [1])
  kWheelCalibration,  // R^7, see motion::WheelCalibration
};

inline constexpr std::size_t kNumVariableKinds = 4;

constexpr int dimension_of(VariableKind kind) {
  constexpr int kDimensions[] = {3, 2, 4, 7};  // in the order of VariableKind
  return kDimensions[static_cast<std::size_t>(kind)];
}

struct Key {
  VariableKind kind = VariableKind::kPose;
  std::uint32_t index = 0;

  auto operator<=>(const Key&) const = default;
  [[nodiscard]] int dimension() const { return dimension_of(kind); }
};

inline Key pose_key(std::uint32_t index) { return {VariableKind::kPose, index}; }
inline Key velocity_key(std::uint32_t index) { return {VariableKind::kVelocity, index}; }
inline Key bias_key(std::uint32_t index) { return {VariableKind::kBias, index}; }
inline Key wheel_calibration_key(std::uint32_t index) {
  return {VariableKind::kWheelCalibration, index};
}

// "pose 12", for messages.
std::string to_text(Key key);

}  // namespace corridor::graph
