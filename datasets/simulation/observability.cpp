#include "datasets/simulation/observability.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

constexpr double kSameDirection_rad = kRadPerDeg;

// Directions are lines: pi apart is the same.
double line_angle_between(double first_rad, double second_rad) {
  return std::abs(std::remainder(first_rad - second_rad, std::numbers::pi));
}

bool is_same(const std::optional<double>& first_rad, const std::optional<double>& second_rad) {
  if (!first_rad || !second_rad) return !first_rad && !second_rad;
  return line_angle_between(*first_rad, *second_rad) < kSameDirection_rad;
}

double line_angle(const Eigen::Vector2d& direction) {
  const double angle_rad = std::atan2(direction.y(), direction.x());
  const double wrapped_rad = angle_rad < 0 ? angle_rad + std::numbers::pi : angle_rad;
  return wrapped_rad >= std::numbers::pi ? 0 : wrapped_rad;
}

}  // namespace

std::optional<FreeDirection> free_direction(std::span<const std::optional<BeamHit>> hits) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // order (x, y) of the world
  for (const auto& hit : hits) {
    if (hit && !hit->is_person) information += hit->normal * hit->normal.transpose();
  }
  if (information.trace() == 0) return FreeDirection{};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(information);  // ascending
  if (solver.eigenvalues()[0] >= kDegenerateShare * information.trace()) return std::nullopt;
  return FreeDirection{line_angle(solver.eigenvectors().col(0))};
}

void DegenerateIntervals::add(Timestamp stamp, const std::optional<FreeDirection>& free) {
  const double stamp_s = to_seconds(stamp);
  if (free && is_open_ && is_same(intervals_.back().direction_rad, free->direction_rad)) {
    intervals_.back().end_s = stamp_s;
  } else if (free) {
    intervals_.push_back({stamp_s, stamp_s, free->direction_rad});
  }
  is_open_ = free.has_value();
}

}  // namespace corridor::simulation
