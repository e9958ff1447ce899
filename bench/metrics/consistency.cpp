#include "bench/metrics/consistency.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "slam/backend/isam2/isam2.hpp"

namespace corridor::metrics {
namespace {

constexpr std::size_t kSampledPoses = 50;

struct SolvedPose {
  std::uint32_t index = 0;
  Pose2 T_world_base;  // true
};

std::vector<SolvedPose> with_truth(const graph::GraphSource& source, const Trajectory& truth) {
  std::vector<SolvedPose> poses;
  std::uint32_t index = 0;
  for (const Timestamp stamp : source.pose_stamps()) {
    const auto T_world_base = truth.interpolate(stamp);
    const bool is_solved = source.solved_values().contains(graph::pose_key(index));
    if (T_world_base && is_solved) poses.push_back({index, *T_world_base});
    ++index;
  }
  return poses;
}

// The same factors at the same values, for their covariances.
std::unique_ptr<backend::BackEnd> copy_of(const graph::GraphSource& source) {
  auto back_end = backend::make_isam2({});
  std::vector<graph::NewFactor> factors;
  source.solved_graph().for_each([&](graph::FactorId, const auto& factor, const auto& kernel) {
    factors.emplace_back(factor, kernel);
  });
  back_end->add(std::move(factors), source.solved_values());
  return back_end;
}

}  // namespace

std::optional<Consistency> score_consistency(const graph::GraphSource& source,
                                             const Trajectory& truth_world) {
  const std::vector<SolvedPose> poses = with_truth(source, truth_world);
  if (poses.size() < 2) return std::nullopt;
  const auto back_end = copy_of(source);
  const graph::Values& values = source.solved_values();
  const Pose2 T_map_world = values.pose(poses.front().index) * poses.front().T_world_base.inverse();
  Consistency consistency;
  int num = 0;
  // From the last pose back, without the first, which has no error.
  const std::size_t step = (poses.size() - 1 + kSampledPoses - 1) / kSampledPoses;
  for (std::size_t back = 0; back + 1 < poses.size(); back += step) {
    const SolvedPose& solved = poses[poses.size() - 1 - back];
    const auto covariance = back_end->marginal_covariance(graph::pose_key(solved.index));
    if (!covariance) return std::nullopt;
    const Eigen::Vector3d error =
        (T_map_world * solved.T_world_base).minus(values.pose(solved.index));
    const Eigen::LDLT<Eigen::Matrix3d> factored(Eigen::Matrix3d{*covariance});
    const double nees = error.dot(factored.solve(error));
    if (!factored.isPositive() || !std::isfinite(nees)) return std::nullopt;
    if (back == 0) consistency.nees_last = nees;
    consistency.nees_mean += nees;
    ++num;
  }
  consistency.nees_mean /= num;
  return consistency;
}

}  // namespace corridor::metrics
