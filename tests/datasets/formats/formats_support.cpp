#include "tests/datasets/formats/formats_support.hpp"

#include <fstream>
#include <sstream>

namespace corridor::formats::test {
namespace {

bool same(const LaserScan& a, const LaserScan& b) {
  return a.stamp == b.stamp && a.angle_min_rad == b.angle_min_rad &&
         a.angle_increment_rad == b.angle_increment_rad && a.range_min_m == b.range_min_m &&
         a.range_max_m == b.range_max_m && a.duration_s == b.duration_s &&
         a.T_base_lidar == b.T_base_lidar && a.ranges_m == b.ranges_m && a.is_valid == b.is_valid;
}

bool same(const WheelSample& a, const WheelSample& b) {
  const bool same_ticks =
      a.ticks.has_value() == b.ticks.has_value() &&
      (!a.ticks || (a.ticks->left == b.ticks->left && a.ticks->right == b.ticks->right));
  return a.stamp == b.stamp && a.T_odom_base == b.T_odom_base && same_ticks;
}

bool same(const ImuSample& a, const ImuSample& b) {
  return a.stamp == b.stamp && a.gyro_z_radps == b.gyro_z_radps &&
         a.accel_x_mps2 == b.accel_x_mps2 && a.accel_y_mps2 == b.accel_y_mps2;
}

LaserScan small_scan(int index) {
  LaserScan scan;
  scan.stamp = {100'000'000LL * (index + 1)};
  scan.angle_min_rad = -0.875;
  scan.angle_increment_rad = 0.25;
  scan.range_min_m = 0.05;
  scan.range_max_m = 4.5;
  scan.T_base_lidar = Pose2(0.25, 0, 0);
  for (int beam = 0; beam < 8; ++beam) {
    const bool is_valid = beam != 3;
    scan.ranges_m.push_back(is_valid ? 1.0F + 0.125F * static_cast<float>(beam + index) : 5.5F);
    scan.is_valid.push_back(is_valid ? 1 : 0);
  }
  return scan;
}

}  // namespace

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

SensorLog small_log() {
  SensorLog log;
  log.robot.name = "small \"robot\"";
  log.robot.lidar.T_base_lidar = Pose2(0.25, 0, 0);
  log.robot.lidar.range_max_m = 4.5;
  log.robot.imu.T_base_imu = Pose2(-0.125, 0.0625, 0);
  for (int centisecond = 0; centisecond <= 40; ++centisecond) {
    const Timestamp stamp{10'000'000LL * centisecond};
    const double x_m = 0.004 * centisecond;
    log.events.emplace_back(ImuSample{stamp, 0.01 * centisecond, 0.1, -0.2});
    if (centisecond % 5 == 0) {
      log.events.emplace_back(WheelSample{stamp, Pose2(x_m, 0.1 * x_m, 0.01 * centisecond),
                                          WheelTicks{40 * centisecond, 41 * centisecond}});
    }
    if (centisecond % 10 == 0 && centisecond > 0) {
      log.events.emplace_back(small_scan(centisecond / 10 - 1));
    }
  }
  return log;
}

bool same_events(const SensorLog& a, const SensorLog& b) {
  if (a.events.size() != b.events.size()) return false;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    if (a.events[i].index() != b.events[i].index()) return false;
    const bool is_same = std::visit(
        [&](const auto& reading) {
          return same(reading, std::get<std::decay_t<decltype(reading)>>(b.events[i]));
        },
        a.events[i]);
    if (!is_same) return false;
  }
  return true;
}

}  // namespace corridor::formats::test
