#include "slam/motion/imu_track.hpp"

#include <algorithm>

namespace corridor::motion {
namespace {

constexpr double kHeldIntervals = 3;
constexpr double kMinHold_s = 0.02;

}  // namespace

void ImuTrack::integrate(const ImuSample& sample, double duration_s) {
  if (duration_s > 0) preintegrator_.integrate(sample, duration_s);
}

void ImuTrack::add(const ImuSample& sample) {
  if (last_) {
    const double interval_s = seconds_between(last_->stamp, sample.stamp);
    hold_s_ = std::clamp(kHeldIntervals * interval_s, kMinHold_s, kMaxHold_s);
  }
  if (integrated_until_) {
    const double since_s = seconds_between(*integrated_until_, sample.stamp);
    const double held_s = std::min(since_s, hold_s_);
    if (since_s > held_s) preintegrator_.coast(since_s - held_s);
    integrate(sample, held_s);
  }
  last_ = sample;
  if (!integrated_until_ || *integrated_until_ < sample.stamp) integrated_until_ = sample.stamp;
}

void ImuTrack::advance_to(Timestamp stamp) {
  if (!last_ || stamp <= *integrated_until_) return;
  const double since_s = seconds_between(*integrated_until_, stamp);
  const double age_s = seconds_between(last_->stamp, *integrated_until_);
  const double held_s = std::clamp(hold_s_ - age_s, 0.0, since_s);
  integrate(*last_, held_s);
  if (since_s > held_s) preintegrator_.coast(since_s - held_s);
  integrated_until_ = stamp;
}

}  // namespace corridor::motion
