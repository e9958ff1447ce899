#include "slam/graph/values.hpp"

#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::graph {
namespace {

template <class T>
const T& get(const std::vector<std::optional<T>>& slots, std::uint32_t index) {
  CORRIDOR_EXPECT(index < slots.size() && slots[index].has_value());
  return *slots[index];
}

template <class T>
void append_keys(const std::vector<std::optional<T>>& slots, VariableKind kind,
                 std::vector<Key>& keys) {
  for (std::uint32_t i = 0; i < slots.size(); ++i) {
    if (slots[i]) keys.push_back({kind, i});
  }
}

}  // namespace

std::string to_text(Key key) {
  constexpr const char* kNames[] = {"pose", "velocity", "bias", "wheel scale"};
  return std::string(kNames[static_cast<std::size_t>(key.kind)]) + " " + std::to_string(key.index);
}

template <class T>
void Values::set(std::vector<std::optional<T>>& slots, std::uint32_t index, const T& value) {
  if (index >= slots.size()) slots.resize(index + 1);
  if (!slots[index]) ++num_values_;
  slots[index] = value;
}

void Values::set_pose(std::uint32_t index, const Pose2& T_map_base) {
  CORRIDOR_EXPECT(T_map_base.is_finite());
  set(poses_, index, T_map_base);
}

void Values::set_velocity(std::uint32_t index, const Eigen::Vector2d& velocity_mps) {
  CORRIDOR_EXPECT(velocity_mps.allFinite());
  set(velocities_, index, velocity_mps);
}

void Values::set_bias(std::uint32_t index, const Eigen::Vector3d& bias) {
  CORRIDOR_EXPECT(bias.allFinite());
  set(biases_, index, bias);
}

void Values::set_wheel_scale(std::uint32_t index, double scale_ratio) {
  CORRIDOR_EXPECT(std::isfinite(scale_ratio));
  set(wheel_scales_, index, scale_ratio);
}

bool Values::contains(Key key) const {
  const auto has = [&](const auto& slots) {
    return key.index < slots.size() && slots[key.index].has_value();
  };
  switch (key.kind) {
    case VariableKind::kPose:
      return has(poses_);
    case VariableKind::kVelocity:
      return has(velocities_);
    case VariableKind::kBias:
      return has(biases_);
    case VariableKind::kWheelScale:
      return has(wheel_scales_);
  }
  return false;
}

const Pose2& Values::pose(std::uint32_t index) const { return get(poses_, index); }
const Eigen::Vector2d& Values::velocity(std::uint32_t index) const {
  return get(velocities_, index);
}
const Eigen::Vector3d& Values::bias(std::uint32_t index) const { return get(biases_, index); }
double Values::wheel_scale(std::uint32_t index) const { return get(wheel_scales_, index); }

void Values::retract(Key key, const Eigen::Ref<const Eigen::VectorXd>& delta) {
  CORRIDOR_EXPECT(contains(key) && delta.rows() == key.dimension());
  switch (key.kind) {
    case VariableKind::kPose:
      poses_[key.index] = poses_[key.index]->plus(Eigen::Vector3d(delta));
      return;
    case VariableKind::kVelocity:
      *velocities_[key.index] += delta;
      return;
    case VariableKind::kBias:
      *biases_[key.index] += delta;
      return;
    case VariableKind::kWheelScale:
      *wheel_scales_[key.index] += delta(0);
      return;
  }
}

void Values::merge(const Values& other) {
  for (std::uint32_t i = 0; i < other.poses_.size(); ++i) {
    if (other.poses_[i]) set(poses_, i, *other.poses_[i]);
  }
  for (std::uint32_t i = 0; i < other.velocities_.size(); ++i) {
    if (other.velocities_[i]) set(velocities_, i, *other.velocities_[i]);
  }
  for (std::uint32_t i = 0; i < other.biases_.size(); ++i) {
    if (other.biases_[i]) set(biases_, i, *other.biases_[i]);
  }
  for (std::uint32_t i = 0; i < other.wheel_scales_.size(); ++i) {
    if (other.wheel_scales_[i]) set(wheel_scales_, i, *other.wheel_scales_[i]);
  }
}

std::vector<Key> Values::keys() const {
  std::vector<Key> keys;
  keys.reserve(num_values_);
  append_keys(poses_, VariableKind::kPose, keys);
  append_keys(velocities_, VariableKind::kVelocity, keys);
  append_keys(biases_, VariableKind::kBias, keys);
  append_keys(wheel_scales_, VariableKind::kWheelScale, keys);
  return keys;
}

}  // namespace corridor::graph
