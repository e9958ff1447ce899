#include "datasets/formats/tick_odometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace corridor::formats {
namespace {

// Allowed besides the speed: readings that were late.
constexpr double kSlack_m = 0.5;

double rolled_m(std::int64_t from, std::int64_t to, double m_per_tick) {
  return static_cast<double>(to - from) * m_per_tick;
}

}  // namespace

Result<WheelSample> TickOdometry::take(Timestamp stamp, const WheelTicks& ticks,
                                       const std::string& where) {
  WheelSample sample{stamp, Pose2(), ticks};
  if (last_) {
    const double left_m = rolled_m(last_->ticks->left, ticks.left, wheels_.left_m_per_tick);
    const double right_m = rolled_m(last_->ticks->right, ticks.right, wheels_.right_m_per_tick);
    const double fastest_m = std::max(std::abs(left_m), std::abs(right_m));
    const double step_s = seconds_between(last_->stamp, stamp);
    const double max_speed_mps = LogLimits{}.max_speed_mps;
    if (fastest_m > max_speed_mps * std::max(step_s, 0.0) + kSlack_m) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("a wheel rolls {:.3f} m in {:.4f} s", fastest_m, step_s), where,
                  fmt::format("at most {} m/s", max_speed_mps));
    }
    sample.T_odom_base = last_->T_odom_base.plus(
        {0.5 * (right_m + left_m), 0, (right_m - left_m) / wheels_.track_m});
  }
  last_ = sample;
  return sample;
}

Result<void> integrate_wheel_ticks(std::vector<SensorEvent>& events, const WheelModel& wheels,
                                   const std::string& where) {
  TickOdometry odometry(wheels);
  for (SensorEvent& event : events) {
    auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr) continue;
    Result<WheelSample> taken = odometry.take(sample->stamp, *sample->ticks, where);
    if (!taken) return tl::make_unexpected(taken.error());
    *sample = *taken;
  }
  return {};
}

}  // namespace corridor::formats
