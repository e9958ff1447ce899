#include "datasets/formats/robot_toml.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "datasets/formats/robot_table.hpp"
#include "datasets/formats/toml_text.hpp"
#include "slam/core/units.hpp"

namespace corridor::formats {
namespace {

Result<RobotOverride> parse(std::string_view text, std::string_view where, RobotTables kind,
                            RobotOverride base) {
  const Result<toml::table> document = parse_toml_text(text, where);
  if (!document) return tl::make_unexpected(document.error());
  std::vector<TomlProblem> problems;
  RobotOverride stated = read_robot_table(*document, "", kind, std::move(base), problems);
  if (!problems.empty()) return tl::make_unexpected(to_error(std::string(where), problems));
  return stated;
}

// A degree value that read back gives the angle again, where one exists beside the nearest.
double to_degrees(double angle_rad) {
  const double nearest = angle_rad / kRadPerDeg;
  for (const double candidate :
       {nearest, std::nextafter(nearest, 360.0), std::nextafter(nearest, -360.0)}) {
    if (candidate * kRadPerDeg == angle_rad) return candidate;
  }
  return nearest;
}

// TOML tells integers from floats by the point.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

void add_pose(std::string_view table, const Pose2& T_base_sensor,
              std::vector<RobotEntry>& entries) {
  entries.push_back({table, "x_m", number(T_base_sensor.x_m())});
  entries.push_back({table, "y_m", number(T_base_sensor.y_m())});
  entries.push_back({table, "yaw_deg", number(to_degrees(T_base_sensor.theta_rad()))});
}

void add_lidar(const LidarModel& lidar, std::vector<RobotEntry>& entries) {
  add_pose("lidar", lidar.T_base_lidar, entries);
  entries.push_back({"lidar", "range_min_m", number(lidar.range_min_m)});
  entries.push_back({"lidar", "range_max_m", number(lidar.range_max_m)});
  entries.push_back({"lidar", "range_sigma_m", number(lidar.range_sigma_m)});
  entries.push_back({"lidar", "scan_duration_s", number(lidar.scan_duration_s)});
  entries.push_back({"lidar", "time_offset_s", number(lidar.time_offset_s)});
}

void add_imu(const ImuModel& imu, std::vector<RobotEntry>& entries) {
  add_pose("imu", imu.T_base_imu, entries);
  entries.push_back({"imu", "rate_hz", number(imu.rate_hz)});
  entries.push_back({"imu", "gyro_noise_radps", number(imu.gyro_noise_radps)});
  entries.push_back({"imu", "accel_noise_mps2", number(imu.accel_noise_mps2)});
  entries.push_back(
      {"imu", "gyro_bias_walk_radps_sqrt_s", number(imu.gyro_bias_walk_radps_sqrt_s)});
  entries.push_back(
      {"imu", "accel_bias_walk_mps2_sqrt_s", number(imu.accel_bias_walk_mps2_sqrt_s)});
}

}  // namespace

std::string RobotEntry::path() const { return fmt::format("{}.{}", table, key); }

std::vector<RobotEntry> robot_entries(const RobotModel& robot) {
  const auto& [name, wheels, lidar, imu] = robot;
  std::vector<RobotEntry> entries;
  entries.push_back({"robot", "name", quoted(name)});
  entries.push_back({"wheels", "track_m", number(wheels.track_m)});
  entries.push_back({"wheels", "left_m_per_tick", number(wheels.left_m_per_tick)});
  entries.push_back({"wheels", "right_m_per_tick", number(wheels.right_m_per_tick)});
  entries.push_back({"wheels", "sigma_m_per_sqrt_m", number(wheels.sigma_m_per_sqrt_m)});
  add_lidar(lidar, entries);
  add_imu(imu, entries);
  return entries;
}

std::string robot_to_toml(const RobotModel& robot) {
  std::string text;
  std::string_view table;
  for (const RobotEntry& entry : robot_entries(robot)) {
    if (entry.table != table) text += fmt::format("[{}]\n", entry.table);
    table = entry.table;
    text += fmt::format("{} = {}\n", entry.key, entry.value);
  }
  return text;
}

Result<StatedRobot> robot_from_toml(std::string_view text, std::string_view where) {
  auto stated = parse(text, where, RobotTables::kComplete, {});
  if (!stated) return tl::make_unexpected(stated.error());
  return StatedRobot{std::move(stated->robot), std::move(stated->keys)};
}

Result<RobotOverride> override_robot(const RobotModel& base, std::string_view text,
                                     std::string_view where, const RawSensors& raw_base) {
  return parse(text, where, RobotTables::kOverride, {base, {}, raw_base});
}

}  // namespace corridor::formats
