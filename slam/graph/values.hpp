// The current estimate of every variable of a factor graph.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/graph/key.hpp"

namespace corridor::graph {

class Values {
 public:
  // Each sets or replaces; the value must be finite.
  void set_pose(std::uint32_t index, const Pose2& T_map_base);
  void set_velocity(std::uint32_t index, const Eigen::Vector2d& velocity_mps);
  void set_bias(std::uint32_t index, const Eigen::Vector3d& bias);
  void set_wheel_scale(std::uint32_t index, double scale_ratio);

  [[nodiscard]] bool contains(Key key) const;
  // Each requires contains(key).
  [[nodiscard]] const Pose2& pose(std::uint32_t index) const;
  [[nodiscard]] const Eigen::Vector2d& velocity(std::uint32_t index) const;
  [[nodiscard]] const Eigen::Vector3d& bias(std::uint32_t index) const;
  [[nodiscard]] double wheel_scale(std::uint32_t index) const;

  // value := value (+) delta: Pose2::plus for poses, a sum for the others. `delta` has
  // key.dimension() rows.
  void retract(Key key, const Eigen::Ref<const Eigen::VectorXd>& delta);
  // Takes over every variable of `other`.
  void merge(const Values& other);

  // In ascending order (kind, index).
  [[nodiscard]] std::vector<Key> keys() const;
  [[nodiscard]] std::size_t size() const { return num_values_; }

 private:
  template <class T>
  void set(std::vector<std::optional<T>>& slots, std::uint32_t index, const T& value);

  // Indices are dense by convention: a slot per index, empty where no variable has it.
  std::vector<std::optional<Pose2>> poses_;
  std::vector<std::optional<Eigen::Vector2d>> velocities_;
  std::vector<std::optional<Eigen::Vector3d>> biases_;
  std::vector<std::optional<double>> wheel_scales_;
  std::size_t num_values_ = 0;
};

}  // namespace corridor::graph
