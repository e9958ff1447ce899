// Wheel odometry from cumulative encoder ticks, for logs that hold nothing else. Internal to this
// folder.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/sensor_log.hpp"
#include "slam/core/wheel.hpp"

namespace corridor::formats {

// Between two readings both wheels roll without slip at constant speed: the base moves on a circle,
// Exp(((right + left) / 2, 0, (right - left) / track)). The first reading is the origin.
class TickOdometry {
 public:
  explicit TickOdometry(const WheelModel& wheels) : wheels_(wheels) {}

  // An Error at `where` if a wheel rolls faster than any robot's: a jump of one wheel is a spin on
  // the spot, in which the pose shows nothing.
  Result<WheelSample> take(Timestamp stamp, const WheelTicks& ticks, const std::string& where);

 private:
  WheelModel wheels_;
  std::optional<WheelSample> last_;
};

// The same for the wheel samples among events in order, each of which must have ticks.
Result<void> integrate_wheel_ticks(std::vector<SensorEvent>& events, const WheelModel& wheels,
                                   const std::string& where);

}  // namespace corridor::formats
