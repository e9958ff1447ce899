#include "slam/motion/wheel_track.hpp"

#include <algorithm>

namespace corridor::motion {
namespace {

Pose2 along(const WheelSample& from, const WheelSample& to, Timestamp stamp) {
  const double ratio = seconds_between(from.stamp, stamp) / seconds_between(from.stamp, to.stamp);
  return from.T_odom_base.plus(ratio * to.T_odom_base.minus(from.T_odom_base));
}

}  // namespace

void WheelTrack::add(const WheelSample& sample) {
  samples_.push_back(sample);
  while (samples_.size() > 2 && seconds_between(samples_[1].stamp, sample.stamp) > kHistory_s) {
    samples_.pop_front();
  }
}

std::optional<Pose2> WheelTrack::pose_at(Timestamp stamp) const {
  if (samples_.empty()) return std::nullopt;
  const auto later =
      std::lower_bound(samples_.begin(), samples_.end(), stamp,
                       [](const WheelSample& sample, Timestamp t) { return sample.stamp < t; });
  if (later == samples_.end()) {
    const WheelSample& last = samples_.back();
    if (seconds_between(last.stamp, stamp) > kMaxExtrapolation_s) return std::nullopt;
    return samples_.size() < 2 ? last.T_odom_base
                               : along(samples_[samples_.size() - 2], last, stamp);
  }
  if (later->stamp == stamp) return later->T_odom_base;
  if (later == samples_.begin()) {
    if (seconds_between(stamp, later->stamp) > kMaxExtrapolation_s) return std::nullopt;
    return later->T_odom_base;
  }
  return along(*std::prev(later), *later, stamp);
}

}  // namespace corridor::motion
