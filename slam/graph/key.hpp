// The name of a variable in a factor graph.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace corridor::graph {

// What a variable is; it fixes the variable's dimension.
enum class VariableKind : std::uint32_t {
  kPose,        // SE(2), T_map_base; tangent order (x_m, y_m, theta_rad) in base
  kVelocity,    // R^2 [m/s], of the base in the map frame
  kBias,        // R^3, order (gyro z [rad/s], accelerometer x, y [m/s^2])
  kWheelScale,  // R^1, true path = (1 + value) * path by nominal wheel radii
};

inline constexpr std::size_t kNumVariableKinds = 4;

constexpr int dimension_of(VariableKind kind) {
  if (kind == VariableKind::kWheelScale) return 1;
  return kind == VariableKind::kVelocity ? 2 : 3;
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
inline Key wheel_scale_key(std::uint32_t index) { return {VariableKind::kWheelScale, index}; }

// "pose 12", for messages.
std::string to_text(Key key);

}  // namespace corridor::graph
