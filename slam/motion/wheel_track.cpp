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

Eigen::Vector3d WheelTrack::twist_at(Timestamp stamp) const {
  if (samples_.size() < 2) return Eigen::Vector3d::Zero();
  auto later =
      std::lower_bound(samples_.begin() + 1, samples_.end() - 1, stamp,
                       [](const WheelSample& sample, Timestamp t) { return sample.stamp < t; });
  const WheelSample& earlier = *std::prev(later);
  return later->T_odom_base.minus(earlier.T_odom_base) /
         seconds_between(earlier.stamp, later->stamp);
}

std::optional<WheelDelta> WheelTrack::between(Timestamp from, Timestamp to,
                                              const WheelCalibration& calibration) const {
  const Timestamp begin = add_seconds(from, calibration(kDelay));
  const Timestamp end = add_seconds(to, calibration(kDelay));
  const std::optional<Pose2> first = pose_at(begin);
  const std::optional<Pose2> last = pose_at(end);
  if (!first || !last) return std::nullopt;
  WheelDelta delta(calibration);
  Pose2 reached = *first;
  for (const WheelSample& sample : samples_) {
    if (sample.stamp <= begin) continue;
    if (sample.stamp >= end) break;
    delta.append(reached.between(sample.T_odom_base));
    reached = sample.T_odom_base;
  }
  delta.append(reached.between(*last));
  delta.set_twists(twist_at(begin), twist_at(end));
  return delta;
}

}  // namespace corridor::motion
