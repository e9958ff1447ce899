#include "slam/matching/observability.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

namespace corridor::matching {

namespace {

// Variance of what defines a frame, as a share of a match's floor.
constexpr double kDefinition = 1e-2;

struct Direction {
  Eigen::Vector3d v;  // in those units
  double information = 0;
  bool is_seen = false;
};

std::array<Direction, 3> directions_of(const MatchResult& match,
                                       const ObservabilityParams& params) {
  const Eigen::Vector3d unit = floor_sigma(params);
  const Eigen::Matrix3d scaled = unit.asDiagonal() * match.information * unit.asDiagonal();
  const Eigen::Matrix3d spurious =
      unit.asDiagonal() * match.spurious_information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scaled);
  const double best = eigen.eigenvalues()(2);
  std::array<Direction, 3> directions;
  for (int i = 0; i < 3; ++i) {
    const double lambda = eigen.eigenvalues()(i);
    const Eigen::Vector3d v = eigen.eigenvectors().col(i);
    const double noise = v.dot(spurious * v);
    directions[static_cast<std::size_t>(i)] = {v, lambda,
                                               lambda > params.min_information_ratio * best &&
                                                   lambda > params.min_spurious_factor * noise &&
                                                   lambda > 0};
  }
  return directions;
}

}  // namespace

Eigen::Vector3d floor_sigma(const ObservabilityParams& params) {
  return {params.translation_floor_m, params.translation_floor_m, params.rotation_floor_rad};
}

Eigen::Matrix3d unseen_information(const MatchResult& match, const ObservabilityParams& params) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Direction& direction : directions_of(match, params)) {
    if (!direction.is_seen) information += direction.v * direction.v.transpose();
  }
  const Eigen::Vector3d per_unit = floor_sigma(params).cwiseInverse();
  return per_unit.asDiagonal() * information * per_unit.asDiagonal();
}

ObservableMatch observable_part(const MatchResult& match, const ObservabilityParams& params) {
  const Eigen::Vector3d unit = floor_sigma(params);
  ObservableMatch part;
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d gradient = unit.cwiseProduct(match.gradient);
  for (const Direction& direction : directions_of(match, params)) {
    if (!direction.is_seen) continue;
    const Eigen::Vector3d& v = direction.v;
    ++part.num_observable;
    step -= v * (v.dot(gradient) / direction.information);
    information += v * v.transpose() /
                   (1 / direction.information + 1);  // the floor's variance is 1 in these units
  }
  part.T_map_base = match.T_map_base.plus(unit.cwiseProduct(step));
  part.information =
      unit.cwiseInverse().asDiagonal() * information * unit.cwiseInverse().asDiagonal();

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> translation(
      Eigen::Matrix2d(match.information.topLeftCorner<2, 2>()));
  part.weakest_direction_base = translation.eigenvectors().col(0);
  const double largest = translation.eigenvalues()(1);
  part.weakest_information_ratio = largest > 0 ? translation.eigenvalues()(0) / largest : 0;
  return part;
}

Eigen::Matrix3d defining_information(const ObservableMatch& match,
                                     const ObservabilityParams& params) {
  const Eigen::Vector3d unit = floor_sigma(params);
  const Eigen::Vector3d per_unit = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
      Eigen::Matrix3d(unit.asDiagonal() * match.information * unit.asDiagonal()));
  Eigen::Vector3d information = eigen.eigenvalues();
  // Eigenvalues ascend: the unseen directions, with none, come first.
  information.head(3 - match.num_observable).setConstant(1 / kDefinition);
  const Eigen::Matrix3d filled =
      eigen.eigenvectors() * information.asDiagonal() * eigen.eigenvectors().transpose();
  return per_unit.asDiagonal() * filled * per_unit.asDiagonal();
}

}  // namespace corridor::matching
