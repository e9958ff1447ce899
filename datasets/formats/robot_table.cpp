#include "datasets/formats/robot_table.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "slam/core/units.hpp"

namespace corridor::formats {
namespace {

template <class T>
using Choices = std::initializer_list<std::pair<std::string_view, T>>;

// Takes the keys of one table into a model and remembers which there were and what is wrong.
class TableReader {
 public:
  TableReader(const toml::table& tables, std::string_view parent, std::string_view name,
              RobotKeys& stated, std::vector<TomlProblem>& problems)
      : name_(name), path_(path_of(parent, name)), stated_(stated), problems_(problems) {
    const toml::node* node = tables.get(name);
    if (node != nullptr && !node->is_table()) problems_.push_back(no_table(*node, path_));
    table_ = node != nullptr ? node->as_table() : nullptr;
  }

  // Number or text.
  template <class T>
  void value(std::string_view key, T& field) {
    const toml::node* node = find(key);
    if (node != nullptr) read_field(*node, path_of(path_, key), field, problems_);
  }

  // For what must be there.
  void require(std::string_view key) {
    if (table_ != nullptr && table_->contains(key)) return;
    const std::uint32_t line = table_ == nullptr ? 0 : table_->source().begin.line;
    problems_.push_back({line, fmt::format("{} is missing; expected number", path_of(path_, key))});
  }

  void positive_number(std::string_view key, double& field) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    read_field(*node, path_of(path_, key), field, problems_);
    if (field > 0) return;
    problems_.push_back({node->source().begin.line,
                         fmt::format("{} = {}: expected > 0", path_of(path_, key), field)});
  }

  void pose(Pose2& T_base_sensor) {
    double x_m = T_base_sensor.x_m();
    double y_m = T_base_sensor.y_m();
    double yaw_deg = 0;
    value("x_m", x_m);
    value("y_m", y_m);
    value("yaw_deg", yaw_deg);
    const bool has_yaw = table_ != nullptr && table_->contains("yaw_deg");
    T_base_sensor = Pose2(x_m, y_m, has_yaw ? yaw_deg * kRadPerDeg : T_base_sensor.theta_rad());
  }

  template <class T>
  void choice(std::string_view key, Choices<T> choices, T& field) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    std::string word;
    if (!read_value(*node, word)) {
      problems_.push_back(wrong_type(*node, path_of(path_, key), expected_text(choices)));
      return;
    }
    for (const auto& [known, meaning] : choices) {
      if (word != known) continue;
      field = meaning;
      return;
    }
    problems_.push_back(
        {node->source().begin.line, fmt::format("{} = \"{}\"; expected {}", path_of(path_, key),
                                                word, expected_text(choices))});
  }

  void refuse_other_keys() {
    if (table_ != nullptr) find_unknown_keys(*table_, path_, known_, problems_);
  }

 private:
  template <class T>
  static std::string expected_text(Choices<T> choices) {
    std::string text;
    for (const auto& [known, meaning] : choices) {
      text += fmt::format("{}\"{}\"", text.empty() ? "" : " or ", known);
    }
    return text;
  }

  const toml::node* find(std::string_view key) {
    const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
    if (node != nullptr) stated_.insert(path_of(name_, key));
    known_.emplace_back(key);
    return node;
  }

  std::string_view name_;
  std::string path_;
  RobotKeys& stated_;
  std::vector<TomlProblem>& problems_;
  const toml::table* table_ = nullptr;
  std::vector<std::string> known_;
};

// Reads the tables of one document, in turn.
class ModelReader {
 public:
  ModelReader(const toml::table& tables, std::string_view parent, RobotOverride base,
              std::vector<TomlProblem>& problems)
      : tables_(tables), parent_(parent), stated_(std::move(base)), problems_(problems) {}

  RobotOverride read(RobotTables kind) {
    take_robot();
    take_wheels(kind);
    take_lidar();
    take_imu();
    if (kind == RobotTables::kOverride) take_raw();
    find_unknown_keys(tables_, parent_, names_, problems_);
    for (const std::string& line : violations(stated_.robot)) {
      problems_.push_back({line_of_violation(tables_, line), path_of(parent_, line)});
    }
    return std::move(stated_);
  }

 private:
  TableReader table(std::string_view name) {
    names_.emplace_back(name);
    return {tables_, parent_, name, stated_.keys, problems_};
  }

  void take_robot() {
    TableReader robot = table("robot");
    robot.value("name", stated_.robot.name);
    robot.refuse_other_keys();
  }

  // Without these keys ticks mean nothing.
  void take_wheels(RobotTables kind) {
    TableReader wheels = table("wheels");
    WheelModel& model = stated_.robot.wheels;
    if (kind == RobotTables::kComplete) {
      for (const auto* key : {"track_m", "left_m_per_tick", "right_m_per_tick"}) {
        wheels.require(key);
      }
    }
    wheels.value("track_m", model.track_m);
    wheels.value("left_m_per_tick", model.left_m_per_tick);
    wheels.value("right_m_per_tick", model.right_m_per_tick);
    wheels.value("sigma_m_per_sqrt_m", model.sigma_m_per_sqrt_m);
    wheels.refuse_other_keys();
  }

  void take_lidar() {
    TableReader lidar = table("lidar");
    LidarModel& model = stated_.robot.lidar;
    lidar.pose(model.T_base_lidar);
    lidar.value("range_min_m", model.range_min_m);
    lidar.value("range_max_m", model.range_max_m);
    lidar.value("range_sigma_m", model.range_sigma_m);
    lidar.value("scan_duration_s", model.scan_duration_s);
    lidar.value("time_offset_s", model.time_offset_s);
    lidar.refuse_other_keys();
  }

  void take_imu() {
    TableReader imu = table("imu");
    ImuModel& model = stated_.robot.imu;
    imu.pose(model.T_base_imu);
    imu.value("rate_hz", model.rate_hz);
    imu.value("gyro_noise_radps", model.gyro_noise_radps);
    imu.value("accel_noise_mps2", model.accel_noise_mps2);
    imu.value("gyro_bias_walk_radps_sqrt_s", model.gyro_bias_walk_radps_sqrt_s);
    imu.value("accel_bias_walk_mps2_sqrt_s", model.accel_bias_walk_mps2_sqrt_s);
    imu.refuse_other_keys();
  }

  void take_raw() {
    TableReader raw = table("raw");
    RawSensors& model = stated_.raw;
    raw.choice<RawClock>("clock",
                         {{"data", RawClock::kData},
                          {"event-offset", RawClock::kEventOffset},
                          {"scan-rate", RawClock::kScanRate}},
                         model.clock);
    raw.choice<bool>("lidar_angles", {{"clockwise", true}, {"counter-clockwise", false}},
                     model.is_lidar_clockwise);
    raw.positive_number("accel_lsb_per_g", model.accel_lsb_per_g);
    raw.positive_number("gyro_lsb_per_dps", model.gyro_lsb_per_dps);
    raw.refuse_other_keys();
  }

  const toml::table& tables_;
  std::string_view parent_;
  RobotOverride stated_;
  std::vector<TomlProblem>& problems_;
  std::vector<std::string> names_;
};

}  // namespace

RobotOverride read_robot_table(const toml::table& tables, std::string_view parent, RobotTables kind,
                               RobotOverride base, std::vector<TomlProblem>& problems) {
  return ModelReader(tables, parent, std::move(base), problems).read(kind);
}

}  // namespace corridor::formats
