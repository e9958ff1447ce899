#include "datasets/formats/tick_odometry.hpp"

#include <optional>

namespace corridor::formats {

void integrate_wheel_ticks(std::vector<SensorEvent>& events, const WheelModel& wheels) {
  std::optional<WheelTicks> last;
  Pose2 T_odom_base;
  for (SensorEvent& event : events) {
    auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr) continue;
    if (last) {
      const double left_m =
          wheels.left_m_per_tick * static_cast<double>(sample->ticks->left - last->left);
      const double right_m =
          wheels.right_m_per_tick * static_cast<double>(sample->ticks->right - last->right);
      T_odom_base = T_odom_base *
                    Pose2::exp({(left_m + right_m) / 2, 0, (right_m - left_m) / wheels.track_m});
    }
    last = sample->ticks;
    sample->T_odom_base = T_odom_base;
  }
}

}  // namespace corridor::formats
