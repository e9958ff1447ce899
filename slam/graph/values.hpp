// The current estimate of every variable of a factor graph.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "slam/core/expect.hpp"
#include "slam/core/pose2.hpp"
#include "slam/graph/key.hpp"
#include "slam/graph/slot_range.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_preintegration.hpp"

namespace corridor::graph {

// A pose with the cosine and sine of its heading, which every factor on it needs.
struct OrientedPose {
  OrientedPose() = default;
  explicit OrientedPose(const Pose2& T)
      : pose(T), cosine(std::cos(T.theta_rad())), sine(std::sin(T.theta_rad())) {}

  [[nodiscard]] Eigen::Matrix2d rotation() const {
    return (Eigen::Matrix2d() << cosine, -sine, sine, cosine).finished();
  }
  // R v and R^T v.
  [[nodiscard]] Eigen::Vector2d turn(const Eigen::Vector2d& v) const {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
  }
  [[nodiscard]] Eigen::Vector2d turn_back(const Eigen::Vector2d& v) const {
    return {cosine * v.x() + sine * v.y(), cosine * v.y() - sine * v.x()};
  }
  // pose * Exp(tau).
  [[nodiscard]] OrientedPose plus(const Pose2::Tangent& tau) const;

  Pose2 pose;
  double cosine = 1, sine = 0;
};

class Values {
  // Indices are dense by convention.
  using AllSlots =
      std::tuple<SlotRange<OrientedPose>, SlotRange<Eigen::Vector2d>, SlotRange<motion::ImuBias>,
                 SlotRange<motion::WheelCalibration>>;  // in the order of VariableKind

  template <VariableKind kKind>
  [[nodiscard]] const auto& get(std::uint32_t index) const {
    const auto& slots = std::get<static_cast<std::size_t>(kKind)>(slots_);
    CORRIDOR_EXPECT(slots.has(index));
    return slots[index];
  }

 public:
  // Each sets or replaces; the value must be finite.
  void set_pose(std::uint32_t index, const Pose2& T_map_base);
  void set_velocity(std::uint32_t index, const Eigen::Vector2d& velocity_mps);
  void set_bias(std::uint32_t index, const motion::ImuBias& bias);
  void set_wheel_calibration(std::uint32_t index, const motion::WheelCalibration& calibration);

  [[nodiscard]] bool contains(Key key) const;
  // Each requires contains(key).
  [[nodiscard]] const Pose2& pose(std::uint32_t index) const { return oriented(index).pose; }
  [[nodiscard]] const OrientedPose& oriented(std::uint32_t index) const {
    return get<VariableKind::kPose>(index);
  }
  [[nodiscard]] const Eigen::Vector2d& velocity(std::uint32_t index) const {
    return get<VariableKind::kVelocity>(index);
  }
  [[nodiscard]] const motion::ImuBias& bias(std::uint32_t index) const {
    return get<VariableKind::kBias>(index);
  }
  [[nodiscard]] const motion::WheelCalibration& wheel_calibration(std::uint32_t index) const {
    return get<VariableKind::kWheelCalibration>(index);
  }
  // Of a variable that is not a pose.
  template <VariableKind kKind>
  [[nodiscard]] const auto& vector(std::uint32_t index) const {
    static_assert(kKind != VariableKind::kPose);
    return get<kKind>(index);
  }

  // value := value (+) delta: Pose2::plus for poses, a sum for the others. `delta` has
  // key.dimension() numbers.
  void retract(Key key, const double* delta);
  // The same for many; `deltas` has theirs one behind the other.
  void retract(std::span<const Key> keys, const double* deltas);
  // value (-) the value in `origin`, into key.dimension() numbers: retract of `origin` by it gives
  // back the value. Both must hold the key.
  void subtract(Key key, const Values& origin, double* delta) const;
  // Sets or replaces one variable as in `other`, which must hold it.
  void copy(Key key, const Values& other);
  // Takes over every variable of `other`.
  void merge(const Values& other);
  // Requires contains(key).
  void erase(Key key);

  // In ascending order (kind, index).
  [[nodiscard]] std::vector<Key> keys() const;
  [[nodiscard]] std::size_t size() const { return num_values_; }

 private:
  template <VariableKind kKind, class T>
  void set(std::uint32_t index, const T& value);

  AllSlots slots_;
  std::size_t num_values_ = 0;
};

}  // namespace corridor::graph
