#include "slam/core/trajectory.hpp"

#include <algorithm>

namespace corridor {

bool Trajectory::append(TrajectoryPose pose) {
  if (!pose.T_map_base.is_finite()) return false;
  if (!poses_.empty() && pose.stamp <= poses_.back().stamp) return false;
  poses_.push_back(std::move(pose));
  return true;
}

std::optional<Pose2> Trajectory::interpolate(Timestamp stamp) const {
  if (empty() || stamp < front().stamp || stamp > back().stamp) return std::nullopt;
  const auto later =
      std::lower_bound(poses_.begin(), poses_.end(), stamp,
                       [](const TrajectoryPose& pose, Timestamp t) { return pose.stamp < t; });
  if (later->stamp == stamp) return later->T_map_base;
  const auto earlier = std::prev(later);
  const double ratio =
      seconds_between(earlier->stamp, stamp) / seconds_between(earlier->stamp, later->stamp);
  return earlier->T_map_base.plus(ratio * later->T_map_base.minus(earlier->T_map_base));
}

double Trajectory::path_length_m() const {
  double length_m = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    length_m +=
        (poses_[i].T_map_base.translation_m() - poses_[i - 1].T_map_base.translation_m()).norm();
  }
  return length_m;
}

}  // namespace corridor
