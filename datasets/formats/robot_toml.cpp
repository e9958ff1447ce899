#include "datasets/formats/robot_toml.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "datasets/formats/toml_text.hpp"
#include "slam/core/units.hpp"

namespace corridor::formats {
namespace {

std::string one_line(const std::vector<std::string>& lines) {
  return fmt::format("{}", fmt::join(lines, "; "));
}

// Takes the keys of one table into a model and remembers what is wrong with them.
class TableReader {
 public:
  TableReader(const toml::table& document, std::string_view name, std::vector<std::string>& wrong)
      : name_(name), wrong_(wrong) {
    const toml::node* node = document.get(name);
    if (node != nullptr && !node->is_table())
      wrong_.push_back(fmt::format("{}: not a table", name));
    table_ = node != nullptr ? node->as_table() : nullptr;
  }

  // True if the key is there.
  bool number(std::string_view key, double& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto found = node->value<double>();
    if (!node->is_number() || !found || !std::isfinite(*found)) {
      wrong_.push_back(fmt::format("{}.{}: not a finite number", name_, key));
    } else {
      value = *found;
    }
    return true;
  }

  void text(std::string_view key, std::string& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_string()) {
      wrong_.push_back(fmt::format("{}.{}: not a text", name_, key));
    } else {
      value = node->value_or(std::string());
    }
  }

  void require(std::string_view key) {
    if (table_ == nullptr || !table_->contains(key)) {
      wrong_.push_back(fmt::format("{}.{}: missing", name_, key));
    }
  }

  // True if any key of the pose is there.
  bool pose(Pose2& T_base_sensor) {
    double x_m = T_base_sensor.x_m();
    double y_m = T_base_sensor.y_m();
    double yaw_deg = 0;
    const bool has_x = number("x_m", x_m);
    const bool has_y = number("y_m", y_m);
    const bool has_yaw = number("yaw_deg", yaw_deg);
    T_base_sensor = Pose2(x_m, y_m, has_yaw ? yaw_deg * kRadPerDeg : T_base_sensor.theta_rad());
    return has_x || has_y || has_yaw;
  }

  void refuse_other_keys() {
    if (table_ == nullptr) return;
    for (const auto& [key, node] : *table_) {
      bool is_known = false;
      for (const std::string_view known : known_) is_known = is_known || known == key.str();
      if (!is_known) wrong_.push_back(fmt::format("{}.{}: unknown key", name_, key.str()));
    }
  }

 private:
  const toml::node* find(std::string_view key) {
    known_.push_back(key);
    return table_ == nullptr ? nullptr : table_->get(key);
  }

  std::string_view name_;
  std::vector<std::string>& wrong_;
  const toml::table* table_ = nullptr;
  std::vector<std::string_view> known_;
};

void take_robot(const toml::table& document, RobotModel& robot, std::vector<std::string>& wrong) {
  TableReader table(document, "robot", wrong);
  table.text("name", robot.name);
  table.refuse_other_keys();
}

// True if the keys without which ticks mean nothing are all there.
bool take_wheels(const toml::table& document, bool is_complete, WheelModel& wheels,
                 std::vector<std::string>& wrong) {
  TableReader table(document, "wheels", wrong);
  if (is_complete) {
    for (const auto* key : {"track_m", "left_m_per_tick", "right_m_per_tick"}) table.require(key);
  }
  const bool has_track = table.number("track_m", wheels.track_m);
  const bool has_left = table.number("left_m_per_tick", wheels.left_m_per_tick);
  const bool has_right = table.number("right_m_per_tick", wheels.right_m_per_tick);
  table.number("sigma_m_per_sqrt_m", wheels.sigma_m_per_sqrt_m);
  table.refuse_other_keys();
  return has_track && has_left && has_right;
}

void take_lidar(const toml::table& document, RobotOverride& stated,
                std::vector<std::string>& wrong) {
  TableReader table(document, "lidar", wrong);
  LidarModel& lidar = stated.robot.lidar;
  stated.states_lidar_pose = table.pose(lidar.T_base_lidar);
  stated.states_range_min = table.number("range_min_m", lidar.range_min_m);
  stated.states_range_max = table.number("range_max_m", lidar.range_max_m);
  stated.states_scan_duration = table.number("scan_duration_s", lidar.scan_duration_s);
  stated.states_range_sigma = table.number("range_sigma_m", lidar.range_sigma_m);
  table.number("time_offset_s", lidar.time_offset_s);
  table.refuse_other_keys();
}

void take_imu(const toml::table& document, RobotOverride& stated, std::vector<std::string>& wrong) {
  TableReader table(document, "imu", wrong);
  ImuModel& imu = stated.robot.imu;
  stated.states_imu_pose = table.pose(imu.T_base_imu);
  table.number("rate_hz", imu.rate_hz);
  table.number("gyro_noise_radps", imu.gyro_noise_radps);
  table.number("accel_noise_mps2", imu.accel_noise_mps2);
  table.number("gyro_bias_walk_radps_sqrt_s", imu.gyro_bias_walk_radps_sqrt_s);
  table.number("accel_bias_walk_mps2_sqrt_s", imu.accel_bias_walk_mps2_sqrt_s);
  table.refuse_other_keys();
}

// One of two words; nothing if the key is not there.
std::optional<bool> take_choice(TableReader& table, std::string_view key, std::string_view if_true,
                                std::string_view if_false, std::vector<std::string>& wrong) {
  std::string word;
  table.text(key, word);
  if (word == if_true) return true;
  if (word == if_false) return false;
  if (!word.empty()) {
    wrong.push_back(
        fmt::format(R"(raw.{} = "{}": expected "{}" or "{}")", key, word, if_true, if_false));
  }
  return std::nullopt;
}

void take_clock(TableReader& table, RawClock& clock, std::vector<std::string>& wrong) {
  std::string word;
  table.text("clock", word);
  if (word == "data") {
    clock = RawClock::kData;
  } else if (word == "event-offset") {
    clock = RawClock::kEventOffset;
  } else if (word == "scan-rate") {
    clock = RawClock::kScanRate;
  } else if (!word.empty()) {
    wrong.push_back(
        fmt::format(R"(raw.clock = "{}": expected "data", "event-offset" or "scan-rate")", word));
  }
}

void take_raw(const toml::table& document, RawSensors& raw, std::vector<std::string>& wrong) {
  TableReader table(document, "raw", wrong);
  take_clock(table, raw.clock, wrong);
  if (const auto is_clockwise =
          take_choice(table, "lidar_angles", "clockwise", "counter-clockwise", wrong)) {
    raw.is_lidar_clockwise = *is_clockwise;
  }
  table.number("accel_lsb_per_g", raw.accel_lsb_per_g);
  table.number("gyro_lsb_per_dps", raw.gyro_lsb_per_dps);
  if (!(raw.accel_lsb_per_g > 0) || !(raw.gyro_lsb_per_dps > 0)) {
    wrong.emplace_back("raw.accel_lsb_per_g and raw.gyro_lsb_per_dps: expected numbers > 0");
  }
  table.refuse_other_keys();
}

// A model inside a log speaks of sensors in SI units: it has no [raw].
void refuse_other_tables(const toml::table& document, bool may_be_raw,
                         std::vector<std::string>& wrong) {
  for (const auto& [key, node] : document) {
    const std::string_view name = key.str();
    const bool is_raw = may_be_raw && name == "raw";
    if (!is_raw && name != "robot" && name != "wheels" && name != "lidar" && name != "imu") {
      wrong.push_back(fmt::format("{}: unknown key", name));
    }
  }
}

Result<RobotOverride> parse(const RobotModel& base, const RawSensors& raw_base, bool is_complete,
                            std::string_view text, std::string_view where) {
  const Result<toml::table> parsed = parse_toml_text(text, where);
  if (!parsed) return tl::make_unexpected(parsed.error());
  const toml::table& document = *parsed;
  RobotOverride stated;
  stated.robot = base;
  stated.raw = raw_base;
  std::vector<std::string> wrong;
  refuse_other_tables(document, !is_complete, wrong);
  take_robot(document, stated.robot, wrong);
  stated.states_wheels = take_wheels(document, is_complete, stated.robot.wheels, wrong);
  take_lidar(document, stated, wrong);
  take_imu(document, stated, wrong);
  if (!is_complete) take_raw(document, stated.raw, wrong);
  for (std::string& line : violations(stated.robot)) wrong.push_back(std::move(line));
  if (!wrong.empty()) {
    return fail(ErrorCode::kInvalid, "robot model: " + one_line(wrong), std::string(where),
                "a valid robot model");
  }
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

std::string pose_lines(const Pose2& T_base_sensor) {
  return fmt::format("x_m = {}\ny_m = {}\nyaw_deg = {}\n", number(T_base_sensor.x_m()),
                     number(T_base_sensor.y_m()), number(to_degrees(T_base_sensor.theta_rad())));
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

}  // namespace

std::string robot_to_toml(const RobotModel& robot) {
  const auto& [name, wheels, lidar, imu] = robot;
  std::string text = fmt::format("[robot]\nname = {}\n", quoted(name));
  text += fmt::format(
      "[wheels]\ntrack_m = {}\nleft_m_per_tick = {}\nright_m_per_tick = {}\n"
      "sigma_m_per_sqrt_m = {}\n",
      number(wheels.track_m), number(wheels.left_m_per_tick), number(wheels.right_m_per_tick),
      number(wheels.sigma_m_per_sqrt_m));
  text += "[lidar]\n" + pose_lines(lidar.T_base_lidar);
  text += fmt::format(
      "range_min_m = {}\nrange_max_m = {}\nrange_sigma_m = {}\nscan_duration_s = {}\n"
      "time_offset_s = {}\n",
      number(lidar.range_min_m), number(lidar.range_max_m), number(lidar.range_sigma_m),
      number(lidar.scan_duration_s), number(lidar.time_offset_s));
  text += "[imu]\n" + pose_lines(imu.T_base_imu);
  text += fmt::format(
      "rate_hz = {}\ngyro_noise_radps = {}\naccel_noise_mps2 = {}\n"
      "gyro_bias_walk_radps_sqrt_s = {}\naccel_bias_walk_mps2_sqrt_s = {}\n",
      number(imu.rate_hz), number(imu.gyro_noise_radps), number(imu.accel_noise_mps2),
      number(imu.gyro_bias_walk_radps_sqrt_s), number(imu.accel_bias_walk_mps2_sqrt_s));
  return text;
}

Result<RobotModel> robot_from_toml(std::string_view text, std::string_view where) {
  auto stated = parse(RobotModel{}, RawSensors{}, true, text, where);
  if (!stated) return tl::make_unexpected(stated.error());
  return std::move(stated->robot);
}

Result<RobotOverride> override_robot(const RobotModel& base, std::string_view text,
                                     std::string_view where, const RawSensors& raw_base) {
  return parse(base, raw_base, false, text, where);
}

}  // namespace corridor::formats
