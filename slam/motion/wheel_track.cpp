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
  if (!samples_.empty() && samples_.back().stamp == sample.stamp) samples_.pop_back();
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

std::pair<const WheelSample*, const WheelSample*> WheelTrack::around(Timestamp moment) const {
  const auto later =
      std::lower_bound(samples_.begin() + 1, samples_.end() - 1, moment,
                       [](const WheelSample& sample, Timestamp t) { return sample.stamp < t; });
  return {&*std::prev(later), &*later};
}

std::optional<WheelReading> WheelTrack::read(Timestamp stamp, double delay_s) const {
  if (!pose_at(stamp)) return std::nullopt;
  const Timestamp moment = add_seconds(stamp, delay_s);
  if (samples_.size() < 2) {
    return WheelReading{moment, samples_.front().T_odom_base, Eigen::Vector3d::Zero()};
  }
  // Before the first sample nothing is known but that one.
  const Timestamp known = std::max(moment, samples_.front().stamp);
  const auto [earlier, later] = around(known);
  const Eigen::Vector3d twist = later->T_odom_base.minus(earlier->T_odom_base) /
                                seconds_between(earlier->stamp, later->stamp);
  return WheelReading{moment, along(*earlier, *later, known), twist};
}

WheelDelta WheelTrack::between(const WheelReading& from, const WheelReading& to,
                               const WheelCalibration& calibration) const {
  WheelDelta delta(calibration);
  Pose2 reached = from.T_odom_axle;
  for (const WheelSample& sample : samples_) {
    if (sample.stamp <= from.moment) continue;
    if (sample.stamp >= to.moment) break;
    delta.append(reached.between(sample.T_odom_base));
    reached = sample.T_odom_base;
  }
  delta.append(reached.between(to.T_odom_axle));
  delta.set_twists(from.twist, to.twist);
  return delta;
}

}  // namespace corridor::motion
