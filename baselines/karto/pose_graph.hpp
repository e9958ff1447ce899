// The key scans' pose graph on any back-end, in Karto's terms.
// Edges have the component error of [Konolige2010] eq. 2; a prior on the first pose fixes the
// gauge. The mapper works in the frame in which odometry started ("map" below), the graph's
// variables are in the frame of the trajectory, that of the base at the first scan, so that both
// agree.
#pragma once

#include <memory>
#include <vector>

#include "baselines/karto/pose_mean.hpp"
#include "slam/backend/back_end.hpp"

namespace corridor::karto {

class PoseGraph {
 public:
  // T_map_start: where the trajectory's frame lies in the mapper's. Requires back_end.
  PoseGraph(std::unique_ptr<backend::BackEnd> back_end, const Pose2& T_map_start);

  // Variables are numbered 0, 1, 2, ... in order of adding; the first is held where it is.
  void add_pose(const Pose2& T_map_base);
  // `to` was matched to lie at `matched.T_map_sensor` while `from` lies at `T_map_base_from`.
  void add_edge(std::uint32_t from, const Pose2& T_map_base_from, std::uint32_t to,
                const PoseWithCovariance& matched, const Pose2& T_base_sensor);
  backend::BackEndReport solve() { return back_end_->solve(); }

  // T_map_base of one variable, as last solved or set.
  [[nodiscard]] Pose2 pose(std::uint32_t index) const {
    return T_map_start_ * back_end_->estimate().pose(index);
  }
  // Overwrites every variable; as many poses as were added.
  void set_poses(const std::vector<Pose2>& T_map_base);

  [[nodiscard]] const graph::Values& values() const { return back_end_->estimate(); }
  [[nodiscard]] const graph::FactorGraph& factors() const { return back_end_->graph(); }

 private:
  std::unique_ptr<backend::BackEnd> back_end_;
  Pose2 T_map_start_;
  std::uint32_t num_poses_ = 0;
};

// Covariance 3x3, order (x_m, y_m, theta_rad), of the base in its own axes, from that of the
// sensor's pose in map axes. For a sensor in the base's origin: R^T C R.
Eigen::Matrix3d covariance_in_base(const PoseWithCovariance& matched, const Pose2& T_base_sensor);

}  // namespace corridor::karto
