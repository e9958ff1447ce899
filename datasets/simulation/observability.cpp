#include "datasets/simulation/observability.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace corridor::simulation {
namespace {

constexpr double kSameDirection_rad = std::numbers::pi / 180;

// Directions are lines: pi apart is the same.
double line_angle_between(double first_rad, double second_rad) {
  return std::abs(std::remainder(first_rad - second_rad, std::numbers::pi));
}

double line_angle(const Eigen::Vector2d& direction) {
  const double angle_rad = std::atan2(direction.y(), direction.x());
  const double wrapped_rad = angle_rad < 0 ? angle_rad + std::numbers::pi : angle_rad;
  return wrapped_rad >= std::numbers::pi ? 0 : wrapped_rad;
}

}  // namespace

std::optional<double> degenerate_direction_rad(std::span<const std::optional<BeamHit>> hits) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // order (x, y) of the world
  for (const auto& hit : hits) {
    if (hit && !hit->is_person) information += hit->normal * hit->normal.transpose();
  }
  if (information.trace() == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(information);  // ascending
  if (solver.eigenvalues()[0] >= kDegenerateShare * information.trace()) return std::nullopt;
  return line_angle(solver.eigenvectors().col(0));
}

void DegenerateIntervals::add(Timestamp stamp, std::optional<double> direction_rad) {
  if (!direction_rad) {
    is_open_ = false;
    return;
  }
  const double stamp_s = to_seconds(stamp);
  if (is_open_ &&
      line_angle_between(*intervals_.back().direction_rad, *direction_rad) < kSameDirection_rad) {
    intervals_.back().end_s = stamp_s;
  } else {
    intervals_.push_back({stamp_s, stamp_s, *direction_rad});
  }
  is_open_ = true;
}

}  // namespace corridor::simulation
