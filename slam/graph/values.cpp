#include "slam/graph/values.hpp"

#include <algorithm>
#include <string>

namespace corridor::graph {
namespace {

// Calls visit(kind, slots) for every kind of variable.
template <class AllSlots, class Visit>
void for_each_kind(AllSlots& all, const Visit& visit) {
  std::uint32_t kind = 0;
  std::apply([&](auto&... slots) { (visit(static_cast<VariableKind>(kind++), slots), ...); }, all);
}

void move(OrientedPose& pose, const double* delta) {
  pose = pose.plus({delta[0], delta[1], delta[2]});
}

template <class Vector>
void move(Vector& value, const double* delta) {
  value += Eigen::Map<const Vector>(delta);
}

}  // namespace

std::string to_text(Key key) {
  constexpr const char* kNames[] = {"pose", "velocity", "bias", "wheel scale"};
  return std::string(kNames[static_cast<std::size_t>(key.kind)]) + " " + std::to_string(key.index);
}

OrientedPose OrientedPose::plus(const Pose2::Tangent& tau) const {
  const Pose2 step = Pose2::exp(tau);
  const Eigen::Vector2d moved = pose.translation_m() + turn(step.translation_m());
  return OrientedPose(Pose2(moved.x(), moved.y(), pose.theta_rad() + step.theta_rad()));
}

template <class T>
void Values::Slots<T>::reach(std::uint32_t index, const T& filler) {
  if (values.empty()) first = index;
  if (index < first) {
    // As many again at least, so that descending indices do not move all of them every time.
    const auto size = static_cast<std::uint32_t>(values.size());
    const std::uint32_t gap = std::max(first - index, std::min(first, size));
    values.insert(values.begin(), gap, filler);
    are_set.insert(are_set.begin(), gap, false);
    first -= gap;
  }
  if (index >= end()) {
    values.resize(index - first + 1, filler);
    are_set.resize(index - first + 1, false);
  }
}

template <class T>
void Values::set(Slots<T>& slots, std::uint32_t index, const T& value) {
  if (!slots.has(index)) {
    slots.reach(index, value);
    slots.are_set[index - slots.first] = true;
    ++num_values_;
  }
  slots.at(index) = value;
}

void Values::set_pose(std::uint32_t index, const Pose2& T_map_base) {
  CORRIDOR_EXPECT(T_map_base.is_finite());
  set(std::get<0>(slots_), index, OrientedPose(T_map_base));
}

void Values::set_velocity(std::uint32_t index, const Eigen::Vector2d& velocity_mps) {
  CORRIDOR_EXPECT(velocity_mps.allFinite());
  set(std::get<1>(slots_), index, velocity_mps);
}

void Values::set_bias(std::uint32_t index, const Eigen::Vector3d& bias) {
  CORRIDOR_EXPECT(bias.allFinite());
  set(std::get<2>(slots_), index, bias);
}

void Values::set_wheel_scale(std::uint32_t index, double scale_ratio) {
  CORRIDOR_EXPECT(std::isfinite(scale_ratio));
  set(std::get<3>(slots_), index, Eigen::Matrix<double, 1, 1>(scale_ratio));
}

bool Values::contains(Key key) const {
  bool is_in = false;
  for_each_kind(slots_, [&](VariableKind kind, const auto& slots) {
    is_in |= kind == key.kind && slots.has(key.index);
  });
  return is_in;
}

void Values::retract(Key key, const double* delta) {
  CORRIDOR_EXPECT(contains(key));
  for_each_kind(slots_, [&](VariableKind kind, auto& slots) {
    if (kind == key.kind) move(slots.at(key.index), delta);
  });
}

void Values::retract(std::span<const Key> keys, const double* deltas) {
  for (const Key key : keys) {
    retract(key, deltas);
    deltas += key.dimension();
  }
}

void Values::merge(const Values& other) {
  const auto take = [this](auto& slots, const auto& from) {
    for (std::uint32_t i = from.first; i < from.end(); ++i) {
      if (from.has(i)) set(slots, i, from.at(i));
    }
  };
  take(std::get<0>(slots_), std::get<0>(other.slots_));
  take(std::get<1>(slots_), std::get<1>(other.slots_));
  take(std::get<2>(slots_), std::get<2>(other.slots_));
  take(std::get<3>(slots_), std::get<3>(other.slots_));
}

std::vector<Key> Values::keys() const {
  std::vector<Key> keys;
  keys.reserve(num_values_);
  for_each_kind(slots_, [&](VariableKind kind, const auto& slots) {
    for (std::uint32_t i = slots.first; i < slots.end(); ++i) {
      if (slots.has(i)) keys.push_back({kind, i});
    }
  });
  return keys;
}

}  // namespace corridor::graph
