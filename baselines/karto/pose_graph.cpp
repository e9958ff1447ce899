#include "baselines/karto/pose_graph.hpp"

#include <vector>

#include "slam/core/expect.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::karto {
namespace {

// 1 / sqrt_m and 1 / rad: holds the first pose to 10 um against edges of centimetres.
constexpr double kGaugeSqrtInformation = 1e5;

}  // namespace

PoseGraph::PoseGraph(std::unique_ptr<backend::BackEnd> back_end, const Pose2& T_map_start)
    : back_end_(std::move(back_end)), T_map_start_(T_map_start) {
  CORRIDOR_EXPECT(back_end_ != nullptr);
}

void PoseGraph::add_pose(const Pose2& T_map_base) {
  const Pose2 T_start_base = T_map_start_.between(T_map_base);
  std::vector<graph::NewFactor> factors;
  if (num_poses_ == 0) {
    factors.push_back(graph::PosePrior(graph::pose_key(0), T_start_base,
                                       kGaugeSqrtInformation * Eigen::Matrix3d::Identity()));
  }
  graph::Values values;
  values.set_pose(num_poses_++, T_start_base);
  back_end_->add(std::move(factors), values);
}

void PoseGraph::add_edge(std::uint32_t from, const Pose2& T_map_base_from, std::uint32_t to,
                         const PoseWithCovariance& matched, const Pose2& T_base_sensor) {
  const Pose2 T_map_base_to = matched.T_map_sensor * T_base_sensor.inverse();
  const Eigen::Matrix3d information = information_of(covariance_in_base(matched, T_base_sensor));
  std::vector<graph::NewFactor> factors;
  factors.push_back(graph::RelativePose(
      graph::pose_key(from), graph::pose_key(to), T_map_base_from.between(T_map_base_to),
      graph::square_root_information(information), graph::RelativePoseError::kComponents));
  back_end_->add(std::move(factors), graph::Values{});
}

void PoseGraph::set_poses(const std::vector<Pose2>& T_map_base) {
  CORRIDOR_EXPECT(T_map_base.size() == num_poses_);
  graph::Values values;
  for (std::uint32_t i = 0; i < num_poses_; ++i) {
    values.set_pose(i, T_map_start_.between(T_map_base[i]));
  }
  back_end_->set_values(values);
}

// p_base = p_sensor - R(theta_base) t, so d p_base = d p_sensor - R'(theta_base) t d theta.
// The original rotates by the first pose's heading and measures the error in its axes; RelativePose
// measures in the second's, so that rotating by the second's heading gives the same chi2.
Eigen::Matrix3d covariance_in_base(const PoseWithCovariance& matched, const Pose2& T_base_sensor) {
  const Pose2 T_map_base = matched.T_map_sensor * T_base_sensor.inverse();
  const Eigen::Vector2d arm_map_m = T_map_base.rotation() * T_base_sensor.translation_m();
  Eigen::Matrix3d base_from_sensor = Eigen::Matrix3d::Identity();
  base_from_sensor(0, 2) = arm_map_m.y();
  base_from_sensor(1, 2) = -arm_map_m.x();
  Eigen::Matrix3d base_from_map = Eigen::Matrix3d::Identity();
  base_from_map.topLeftCorner<2, 2>() = T_map_base.rotation().transpose();
  const Eigen::Matrix3d jacobian = base_from_map * base_from_sensor;
  return jacobian * matched.covariance_map * jacobian.transpose();
}

}  // namespace corridor::karto
