#include "slam/core/same_reading.hpp"

#include <type_traits>

namespace corridor {
namespace {

bool is_same_reading(const WheelSample& a, const WheelSample& b) {
  return a.T_odom_base == b.T_odom_base;
}

bool is_same_reading(const ImuSample& a, const ImuSample& b) {
  return a.gyro_z_radps == b.gyro_z_radps && a.accel_x_mps2 == b.accel_x_mps2 &&
         a.accel_y_mps2 == b.accel_y_mps2;
}

}  // namespace

bool is_same_reading(const LaserScan& a, const LaserScan& b) {
  return a.ranges_m == b.ranges_m && a.is_valid == b.is_valid;
}

bool is_same_reading(const SensorEvent& a, const SensorEvent& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& reading) {
        return is_same_reading(reading, std::get<std::decay_t<decltype(reading)>>(b));
      },
      a);
}

std::string_view difference_of(const SensorEvent& a, const SensorEvent& b) {
  constexpr std::string_view kOther[] = {"other ranges", "another pose", "other values"};
  return is_same_reading(a, b) ? std::string_view() : kOther[a.index()];
}

}  // namespace corridor
