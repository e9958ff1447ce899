// A sequence of stamped poses of the base, strictly ordered in time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor {

struct TrajectoryPose {
  Timestamp stamp;
  Pose2 T_map_base;
  // 3x3, order (x_m, y_m, theta_rad), right perturbation in base.
  std::optional<Pose2::Matrix> covariance_base;
};

// Invariant: stamps strictly increase and poses are finite.
class Trajectory {
 public:
  // False (and nothing is appended) if the stamp is not later than the last or the pose not finite.
  [[nodiscard]] bool append(TrajectoryPose pose);

  [[nodiscard]] const std::vector<TrajectoryPose>& poses() const { return poses_; }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const TrajectoryPose& operator[](std::size_t index) const { return poses_[index]; }
  [[nodiscard]] const TrajectoryPose& front() const { return poses_.front(); }
  [[nodiscard]] const TrajectoryPose& back() const { return poses_.back(); }

  // Geodesic interpolation between the two neighbours; nullopt outside [front, back].
  [[nodiscard]] std::optional<Pose2> interpolate(Timestamp stamp) const;
  // Sum of the distances between consecutive poses [m].
  [[nodiscard]] double path_length_m() const;

 private:
  std::vector<TrajectoryPose> poses_;
};

}  // namespace corridor
