#include "slam/fusion/majority_vote.hpp"

#include <Eigen/Eigenvalues>

namespace corridor::fusion {
namespace {

// Innovation of a match against a witness, over its variance, along one direction in floor units.
double chi2_along(const Eigen::Vector3d& v, double match_variance, const Pose2& T_map_base,
                  const Witness& witness, const Eigen::Vector3d& per_unit) {
  const Eigen::Vector3d scaled_v = v.cwiseProduct(per_unit);
  const double innovation = scaled_v.dot(T_map_base.minus(witness.T_submap_base));
  return innovation * innovation / (match_variance + scaled_v.dot(witness.covariance * scaled_v));
}

Witness witness_of(const Pose2& T_submap_last, const MotionEstimate& motion,
                   const matching::ObservabilityParams& floors) {
  // The pose at the last scan came from a match of the same kind: its error counts too.
  Witness witness{T_submap_last * motion.T_last_now, motion.covariance};
  witness.covariance.diagonal() += matching::floor_sigma(floors).cwiseAbs2();
  return witness;
}

}  // namespace

matching::ObservableMatch without_outvoted(const matching::ObservableMatch& match,
                                           const Witness& wheels, const Witness& imu, double gate,
                                           const matching::ObservabilityParams& floors) {
  const Eigen::Vector3d unit = matching::floor_sigma(floors);
  const Eigen::Vector3d per_unit = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
      Eigen::Matrix3d(unit.asDiagonal() * match.information * unit.asDiagonal()));
  matching::ObservableMatch kept = match;
  // Eigenvalues ascend: the unseen directions, with none, come first.
  for (int i = 3 - match.num_observable; i < 3; ++i) {
    const Eigen::Vector3d v = eigen.eigenvectors().col(i);
    const double information = eigen.eigenvalues()(i);
    if (chi2_along(v, 1 / information, match.T_map_base, wheels, per_unit) <= gate ||
        chi2_along(v, 1 / information, match.T_map_base, imu, per_unit) <= gate) {
      continue;
    }
    const Eigen::Vector3d scaled_v = v.cwiseProduct(per_unit);
    kept.information -= information * scaled_v * scaled_v.transpose();
    --kept.num_observable;
  }
  // What rounding leaves of a match that is outvoted altogether is not information.
  if (kept.num_observable == 0) kept.information.setZero();
  return kept;
}

matching::ObservableMatch put_to_vote(const matching::ObservableMatch& match,
                                      const Pose2& T_submap_last, const Prediction& prediction,
                                      const FusionParams& params) {
  if (!params.use_majority_vote || !prediction.by_wheels || !prediction.by_imu) return match;
  return without_outvoted(match,
                          witness_of(T_submap_last, *prediction.by_wheels, params.observability),
                          witness_of(T_submap_last, *prediction.by_imu, params.observability),
                          params.vote_gate, params.observability);
}

}  // namespace corridor::fusion
