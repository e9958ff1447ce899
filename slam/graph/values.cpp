#include "slam/graph/values.hpp"

#include <algorithm>
#include <string>
#include <type_traits>

namespace corridor::graph {
namespace {

// Calls visit(kind, slots) for every kind of variable.
template <class AllSlots, class Visit>
void for_each_kind(AllSlots& all, const Visit& visit) {
  std::uint32_t kind = 0;
  std::apply([&](auto&... slots) { (visit(static_cast<VariableKind>(kind++), slots), ...); }, all);
}

// Calls visit with the place of that kind's slots among all, as a constant.
template <class Visit>
void with_slots(VariableKind kind, const Visit& visit) {
  switch (kind) {
    case VariableKind::kPose:
      return visit(std::integral_constant<std::size_t, 0>());
    case VariableKind::kVelocity:
      return visit(std::integral_constant<std::size_t, 1>());
    case VariableKind::kBias:
      return visit(std::integral_constant<std::size_t, 2>());
    case VariableKind::kWheelCalibration:
      return visit(std::integral_constant<std::size_t, 3>());
  }
}

void move(OrientedPose& pose, const double* delta) {
  pose = pose.plus({delta[0], delta[1], delta[2]});
}

template <class Vector>
void move(Vector& value, const double* delta) {
  value += Eigen::Map<const Vector>(delta);
}

void difference(const OrientedPose& pose, const OrientedPose& origin, double* delta) {
  const Pose2::Tangent tau = pose.pose.minus(origin.pose);
  std::copy(tau.begin(), tau.end(), delta);
}

template <class Vector>
void difference(const Vector& value, const Vector& origin, double* delta) {
  const Vector step = value - origin;
  std::copy(step.begin(), step.end(), delta);
}

}  // namespace

std::string to_text(Key key) {
  constexpr const char* kNames[] = {"pose", "velocity", "bias", "wheel calibration"};
  return std::string(kNames[static_cast<std::size_t>(key.kind)]) + " " + std::to_string(key.index);
}

OrientedPose OrientedPose::plus(const Pose2::Tangent& tau) const {
  const Pose2 step = Pose2::exp(tau);
  const Eigen::Vector2d moved = pose.translation_m() + turn(step.translation_m());
  return OrientedPose(Pose2(moved.x(), moved.y(), pose.theta_rad() + step.theta_rad()));
}

template <VariableKind kKind, class T>
void Values::set(std::uint32_t index, const T& value) {
  if (std::get<static_cast<std::size_t>(kKind)>(slots_).set(index, value)) ++num_values_;
}

void Values::set_pose(std::uint32_t index, const Pose2& T_map_base) {
  CORRIDOR_EXPECT(T_map_base.is_finite());
  set<VariableKind::kPose>(index, OrientedPose(T_map_base));
}

void Values::set_velocity(std::uint32_t index, const Eigen::Vector2d& velocity_mps) {
  CORRIDOR_EXPECT(velocity_mps.allFinite());
  set<VariableKind::kVelocity>(index, velocity_mps);
}

void Values::set_bias(std::uint32_t index, const motion::ImuBias& bias) {
  CORRIDOR_EXPECT(bias.allFinite());
  set<VariableKind::kBias>(index, bias);
}

void Values::set_wheel_calibration(std::uint32_t index,
                                   const motion::WheelCalibration& calibration) {
  CORRIDOR_EXPECT(calibration.allFinite());
  set<VariableKind::kWheelCalibration>(index, calibration);
}

bool Values::contains(Key key) const {
  bool is_in = false;
  with_slots(key.kind, [&](auto kind) { is_in = std::get<kind>(slots_).has(key.index); });
  return is_in;
}

void Values::retract(Key key, const double* delta) {
  CORRIDOR_EXPECT(contains(key));
  with_slots(key.kind, [&](auto kind) { move(std::get<kind>(slots_)[key.index], delta); });
}

void Values::retract(std::span<const Key> keys, const double* deltas) {
  for (const Key key : keys) {
    retract(key, deltas);
    deltas += key.dimension();
  }
}

void Values::subtract(Key key, const Values& origin, double* delta) const {
  CORRIDOR_EXPECT(contains(key) && origin.contains(key));
  with_slots(key.kind, [&](auto kind) {
    difference(std::get<kind>(slots_)[key.index], std::get<kind>(origin.slots_)[key.index], delta);
  });
}

void Values::copy(Key key, const Values& other) {
  CORRIDOR_EXPECT(other.contains(key));
  with_slots(key.kind, [&](auto kind) {
    set<static_cast<VariableKind>(kind.value)>(key.index, std::get<kind>(other.slots_)[key.index]);
  });
}

void Values::merge(const Values& other) {
  const auto take = [this](auto& slots, const auto& from) {
    from.for_each([&](std::size_t index, const auto& value) {
      if (slots.set(index, value)) ++num_values_;
    });
  };
  take(std::get<0>(slots_), std::get<0>(other.slots_));
  take(std::get<1>(slots_), std::get<1>(other.slots_));
  take(std::get<2>(slots_), std::get<2>(other.slots_));
  take(std::get<3>(slots_), std::get<3>(other.slots_));
}

void Values::erase(Key key) {
  CORRIDOR_EXPECT(contains(key));
  with_slots(key.kind, [&](auto kind) { std::get<kind>(slots_).erase(key.index); });
  --num_values_;
}

std::vector<Key> Values::keys() const {
  std::vector<Key> keys;
  keys.reserve(num_values_);
  for_each_kind(slots_, [&](VariableKind kind, const auto& slots) {
    slots.for_each([&](std::size_t index, const auto&) {
      keys.push_back({kind, static_cast<std::uint32_t>(index)});
    });
  });
  return keys;
}

}  // namespace corridor::graph
