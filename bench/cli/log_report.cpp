#include "bench/cli/log_report.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "bench/cli/command.hpp"
#include "bench/runner/printable.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/units.hpp"

namespace corridor::cli {
namespace {

using formats::StampHealth;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxDefectsShown = 20;

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json number_or_null(const std::optional<double>& number) {
  return number ? Json(*number) : Json(nullptr);
}

Json stamps_json(const StampHealth& stamps) {
  return {{"num_readings", stamps.num_readings},
          {"first_s", stamps.first_s},
          {"last_s", stamps.last_s},
          {"median_rate_hz", stamps.median_rate_hz()},
          {"longest_gap_s", stamps.longest_gap_s},
          {"longest_gap_at", text_or_null(stamps.longest_gap_at)},
          {"num_gaps", stamps.num_gaps},
          {"num_repeated_stamps", stamps.num_repeats},
          {"num_stamps_back", stamps.num_back},
          {"first_bad_stamp_at", text_or_null(stamps.first_bad_at)}};
}

Json lidar_json(const formats::LidarHealth& lidar) {
  return {{"min_beams", lidar.min_beams},
          {"max_beams", lidar.max_beams},
          {"field_of_view_deg", lidar.field_of_view_rad * kDegPerRad},
          {"invalid_ratio", lidar.invalid_ratio},
          {"min_range_m", lidar.min_range_m},
          {"median_range_m", lidar.median_range_m},
          {"max_range_m", lidar.max_range_m},
          {"longest_range_at", text_or_null(lidar.longest_range_at)},
          {"range_limit_m", lidar.range_limit_m},
          {"num_frozen_scans", lidar.num_frozen_scans},
          {"frozen_path_m", lidar.frozen_path_m},
          {"frozen_turn_deg", lidar.frozen_turn_rad * kDegPerRad},
          {"frozen_until", text_or_null(lidar.frozen_until)}};
}

Json wheels_json(const formats::WheelHealth& wheels) {
  return {{"has_ticks", wheels.has_ticks},
          {"path_m", wheels.path_m},
          {"turn_deg", wheels.turn_rad * kDegPerRad},
          {"max_speed_mps", number_or_null(wheels.max_speed_mps)},
          {"max_speed_at", text_or_null(wheels.max_speed_at)},
          {"max_yaw_rate_radps", number_or_null(wheels.max_yaw_rate_radps)},
          {"max_yaw_rate_at", text_or_null(wheels.max_yaw_rate_at)},
          {"num_jumps", wheels.num_jumps}};
}

Json imu_json(const formats::ImuHealth& imu) {
  const auto degrees = [](const std::optional<double>& angle_rad) {
    return angle_rad ? Json(*angle_rad * kDegPerRad) : Json(nullptr);
  };
  return {{"max_gyro_radps", imu.max_gyro_radps},
          {"max_gyro_at", text_or_null(imu.max_gyro_at)},
          {"median_accel_x_mps2", imu.median_accel_x_mps2},
          {"median_accel_y_mps2", imu.median_accel_y_mps2},
          {"gyro_turn_deg", degrees(imu.gyro_turn_rad)},
          {"wheel_turn_deg", degrees(imu.wheel_turn_rad)}};
}

Json truth_json(const formats::TruthHealth& truth) {
  return {{"num_poses", truth.num_poses},
          {"path_m", truth.path_m},
          {"scans_with_pose_ratio", truth.scans_with_pose_ratio},
          {"num_fast_steps", truth.num_fast_steps},
          {"common_path_m", truth.common_path_m},
          {"common_wheel_path_m", truth.common_wheel_path_m}};
}

// Stamps of a sensor and what else is known of it; null for a sensor that the log does not have.
template <class Health, class ToJson>
Json sensor_json(const StampHealth& stamps, const std::optional<Health>& health, ToJson to_json) {
  if (!health) return nullptr;
  Json json = stamps_json(stamps);
  json.update(to_json(*health));
  return json;
}

Json robot_json(const RobotModel& robot) {
  std::ostringstream text;
  text << toml::json_formatter(toml::parse(formats::robot_to_toml(robot)));
  return Json::parse(text.str());
}

// Paths of the values that nobody states.
std::vector<std::string> assumed_keys(const LogReport& report) {
  std::vector<std::string> assumed;
  for (const formats::RobotEntry& entry : formats::robot_entries(report.log->robot)) {
    if (!formats::states(*report.robot_keys, entry.path())) assumed.push_back(entry.path());
  }
  return assumed;
}

std::string remark_on(const formats::RobotEntry& entry, const LogReport& report) {
  if (!formats::states(*report.robot_keys, entry.path())) return "  # assumed";
  const bool is_applied = report.applied_time_offset_s != 0;
  if (!is_applied || entry.path() != "lidar.time_offset_s") return "";
  return fmt::format("  # {} is applied to the scans", report.applied_time_offset_s);
}

// As TOML that LOG.robot.toml can start from.
std::string robot_lines(const LogReport& report) {
  std::string text = "robot model:\n";
  std::string_view table;
  for (const formats::RobotEntry& entry : formats::robot_entries(report.log->robot)) {
    if (entry.table != table) text += fmt::format("  [{}]\n", entry.table);
    table = entry.table;
    text += fmt::format("  {} = {}{}\n", entry.key, runner::printable(entry.value),
                        remark_on(entry, report));
  }
  return text;
}

std::string number_text(double value) { return fmt::format("{:.3f}", value); }

std::string number_or_dash(const std::optional<double>& value) {
  return value ? number_text(*value) : "-";
}

std::string stamp_rows(const formats::LogHealth& health) {
  std::vector<std::vector<std::string>> rows{{"sensor", "readings", "from [s]", "to [s]",
                                              "rate [Hz]", "longest gap [s]", "at", "gaps",
                                              "repeated", "back", "first at"}};
  const auto add = [&rows](const char* sensor, const StampHealth& stamps) {
    if (stamps.num_readings == 0) {
      rows.push_back({sensor, "none"});
      return;
    }
    rows.push_back({sensor, std::to_string(stamps.num_readings), number_text(stamps.first_s),
                    number_text(stamps.last_s), number_text(stamps.median_rate_hz()),
                    number_text(stamps.longest_gap_s),
                    stamps.longest_gap_at.empty() ? "-" : stamps.longest_gap_at,
                    std::to_string(stamps.num_gaps), std::to_string(stamps.num_repeats),
                    std::to_string(stamps.num_back),
                    stamps.first_bad_at.empty() ? "-" : stamps.first_bad_at});
  };
  add("LiDAR", health.lidar_stamps);
  add("wheels", health.wheel_stamps);
  add("IMU", health.imu_stamps);
  return text_table(std::move(rows));
}

std::string line_of(const formats::LidarHealth& lidar) {
  return fmt::format(
      "LiDAR: {} beams over {:.1f} deg, {:.1f} % without return, returns at {:.3f} m to {:.3f} m, "
      "median {:.3f} m, limit {:.3f} m\n",
      lidar.min_beams == lidar.max_beams
          ? std::to_string(lidar.max_beams)
          : fmt::format("{} to {}", lidar.min_beams, lidar.max_beams),
      lidar.field_of_view_rad * kDegPerRad, 100 * lidar.invalid_ratio, lidar.min_range_m,
      lidar.max_range_m, lidar.median_range_m, lidar.range_limit_m);
}

std::string line_of(const formats::WheelHealth& wheels) {
  return fmt::format(
      "wheels: {} m, turns of {:.1f} deg in all, at most {} m/s and {} rad/s, {} jumps, {}\n",
      number_text(wheels.path_m), wheels.turn_rad * kDegPerRad,
      number_or_dash(wheels.max_speed_mps), number_or_dash(wheels.max_yaw_rate_radps),
      wheels.num_jumps, wheels.has_ticks ? "with ticks" : "poses only");
}

std::string line_of(const formats::ImuHealth& imu) {
  std::string text =
      fmt::format("IMU: at most {:.3f} rad/s, median acceleration ({:.3f}, {:.3f}) m/s2",
                  imu.max_gyro_radps, imu.median_accel_x_mps2, imu.median_accel_y_mps2);
  if (imu.gyro_turn_rad && imu.wheel_turn_rad) {
    text += fmt::format(", gyro turns {:.1f} deg where the wheels turn {:.1f} deg",
                        *imu.gyro_turn_rad * kDegPerRad, *imu.wheel_turn_rad * kDegPerRad);
  }
  return text + "\n";
}

std::string line_of(const formats::TruthHealth& truth, bool is_reference) {
  return fmt::format("{}: {} poses, {:.3f} m, {:.1f} % of the scans have one within 10 ms\n",
                     is_reference ? "reference (no truth)" : "truth", truth.num_poses, truth.path_m,
                     100 * truth.scans_with_pose_ratio);
}

std::string sensor_lines(const LogReport& report) {
  const formats::LogHealth& health = *report.health;
  std::string text;
  if (health.lidar) text += line_of(*health.lidar);
  if (health.wheels) text += line_of(*health.wheels);
  if (health.imu) text += line_of(*health.imu);
  text += health.truth ? line_of(*health.truth, report.log->provenance.is_truth_reference)
                       : "truth: no poses\n";
  if (report.num_relations) text += fmt::format("relations: {}\n", *report.num_relations);
  return text;
}

// "prefix: line" for each; at most `max_shown`.
std::string lines_of(const char* prefix, const std::vector<std::string>& lines,
                     std::size_t max_shown) {
  std::string text;
  for (std::size_t i = 0; i < lines.size() && i < max_shown; ++i) {
    text += fmt::format("{}: {}\n", prefix, runner::printable(lines[i]));
  }
  if (lines.size() > max_shown) {
    text += fmt::format("{}: and {} more, see --json\n", prefix, lines.size() - max_shown);
  }
  return text;
}

}  // namespace

Json to_json(const LogReport& report) {
  const SensorLog& log = *report.log;
  const formats::LogHealth& health = *report.health;
  return {{"name", log.provenance.name},
          {"source", log.provenance.source},
          {"format", log.provenance.format},
          {"is_fit", health.defects.empty()},
          {"duration_s", health.duration_s},
          {"lidar", sensor_json(health.lidar_stamps, health.lidar, lidar_json)},
          {"wheels", sensor_json(health.wheel_stamps, health.wheels, wheels_json)},
          {"imu", sensor_json(health.imu_stamps, health.imu, imu_json)},
          {"truth", health.truth ? truth_json(*health.truth) : Json(nullptr)},
          {"num_relations", report.num_relations ? Json(*report.num_relations) : Json(nullptr)},
          {"is_truth_reference", log.provenance.is_truth_reference},
          {"robot_model", robot_json(log.robot)},
          {"assumed", assumed_keys(report)},
          {"notes", log.provenance.notes},
          {"suspicions", health.suspicions},
          {"defects", health.defects}};
}

std::string to_text(const LogReport& report) {
  const SensorLog& log = *report.log;
  const formats::LogHealth& health = *report.health;
  std::string text = fmt::format("{} ({}, {}), {:.3f} s\n", runner::printable(log.provenance.name),
                                 log.provenance.format, runner::printable(log.provenance.source),
                                 health.duration_s);
  text += stamp_rows(health) + sensor_lines(report) + robot_lines(report);
  const std::size_t all = log.provenance.notes.size() + health.suspicions.size();
  text += lines_of("note", log.provenance.notes, all);
  text += lines_of("suspicious", health.suspicions, all);
  text += lines_of("defect", health.defects, kMaxDefectsShown);
  text += health.defects.empty()
              ? fmt::format("fit, {}\n", counted(health.suspicions.size(), "suspicion"))
              : fmt::format("not fit, {}\n", counted(health.defects.size(), "defect"));
  return text;
}

}  // namespace corridor::cli
