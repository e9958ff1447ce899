#include "datasets/simulation/truth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/toml_input.hpp"
#include "datasets/simulation/world_table.hpp"

namespace corridor::simulation {
namespace {

struct StartTable {
  double x_m, y_m, yaw_rad;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"x_m", "m", "start"}, p.x_m);
    v(ParamInfo{"y_m", "m", "start"}, p.y_m);
    v(ParamInfo{"yaw_rad", "rad", "start"}, p.yaw_rad);
  }
};

struct ImuTable {
  double gyro_bias_radps, accel_bias_x_mps2, accel_bias_y_mps2;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"gyro_bias_radps", "rad/s", "constant bias"}, p.gyro_bias_radps);
    v(ParamInfo{"accel_bias_x_mps2", "m/s2", "constant bias"}, p.accel_bias_x_mps2);
    v(ParamInfo{"accel_bias_y_mps2", "m/s2", "constant bias"}, p.accel_bias_y_mps2);
  }
};

struct WheelTable {
  double left_scale, right_scale;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"left_scale", "1", "recorded / true path"}, p.left_scale);
    v(ParamInfo{"right_scale", "1", "recorded / true path"}, p.right_scale);
  }
};

struct LidarTable {
  double range_max_m, range_sigma_m;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"range_max_m", "m", "range"}, p.range_max_m);
    v(ParamInfo{"range_sigma_m", "m", "noise"}, p.range_sigma_m);
  }
};

// What only richer scenarios draw: not in every file.
struct ErrorsTable {
  double track_ratio = 1, gyro_scale = 1, accel_scale_x = 1, accel_scale_y = 1;
  double misalignment_rad = 0, lidar_time_offset_s = 0, imu_time_offset_s = 0;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"track_ratio", "1", "true / stated track"}, p.track_ratio);
    v(ParamInfo{"gyro_scale", "1", "reading / truth"}, p.gyro_scale);
    v(ParamInfo{"accel_scale_x", "1", "reading / truth"}, p.accel_scale_x);
    v(ParamInfo{"accel_scale_y", "1", "reading / truth"}, p.accel_scale_y);
    v(ParamInfo{"misalignment_rad", "rad", "true minus stated yaw of the IMU"}, p.misalignment_rad);
    v(ParamInfo{"lidar_time_offset_s", "s", "LiDAR clock minus wheel clock"},
      p.lidar_time_offset_s);
    v(ParamInfo{"imu_time_offset_s", "s", "IMU clock minus wheel clock"}, p.imu_time_offset_s);
  }
};

struct SlipRow {
  SlipInterval value;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"begin_s", "s", "first moment"}, p.value.begin_s);
    v(ParamInfo{"end_s", "s", "last moment"}, p.value.end_s);
    v(ParamInfo{"ratio", "1", "spin"}, p.value.ratio);
  }
};

struct BlindRow {
  DegenerateInterval value;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"begin_s", "s", "first scan"}, p.value.begin_s);
    v(ParamInfo{"end_s", "s", "last scan"}, p.value.end_s);
  }
};

struct DegenerateRow {
  DegenerateInterval value;
  static void visit(auto& p, auto&& v) {
    BlindRow::visit(p, v);
    if (!p.value.direction_rad) p.value.direction_rad.emplace();
    v(ParamInfo{"direction_rad", "rad", "free direction"}, *p.value.direction_rad);
  }
};

struct BiasRow {
  ImuBiasSample value;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"stamp_s", "s", "moment"}, p.value.stamp_s);
    v(ParamInfo{"gyro_radps", "rad/s", "constant part and drift"}, p.value.bias.gyro_radps);
    v(ParamInfo{"accel_x_mps2", "m/s2", "and leaked gravity"}, p.value.bias.accel_x_mps2);
    v(ParamInfo{"accel_y_mps2", "m/s2", "and leaked gravity"}, p.value.bias.accel_y_mps2);
  }
};

template <class Row>
std::string rows_text(std::string_view key, const auto& values) {
  std::string text = fmt::format("{} = [", key);
  const char* separator = "";
  for (const auto& value : values) {
    Row row{value};
    std::string fields;
    Row::visit(row, [&](const ParamInfo& info, double& field) {
      fields += fmt::format("{}{} = {}", fields.empty() ? "" : ", ", info.name, field);
    });
    text += fmt::format("{}{{ {} }}", separator, fields);
    separator = ", ";
  }
  return text + "]\n";
}

// The list of blind scans is there only where there are some.
std::string degenerate_text(const std::vector<DegenerateInterval>& intervals) {
  std::vector<DegenerateInterval> directed, blind;
  for (const DegenerateInterval& interval : intervals) {
    (interval.direction_rad ? directed : blind).push_back(interval);
  }
  return rows_text<DegenerateRow>("degenerate", directed) +
         (blind.empty() ? "" : rows_text<BlindRow>("blind", blind));
}

template <class Table>
std::string table_text(std::string_view section, Table table) {
  std::string text = fmt::format("[{}]\n", section);
  Table::visit(table, [&](const ParamInfo& info, double& value) {
    text += fmt::format("{} = {}\n", info.name, value);
  });
  return text;
}

// Takes an array of rows out of a table, so that read_table() sees only its plain keys.
template <class Row, class Value>
void take_rows(toml::table& document, std::string_view section, std::string_view key,
               std::vector<Value>& values, std::vector<TomlProblem>& problems) {
  toml::table* table = document.get_as<toml::table>(section);
  if (table == nullptr) return;  // read_section() reports it
  const toml::node* node = table->get(key);
  if (node == nullptr) return;
  const std::string name = fmt::format("{}.{}", section, key);
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    problems.push_back(formats::wrong_type(*node, name, "a list"));
  } else {
    for (const toml::node& element : *array) {
      Row row{};
      if (const toml::table* fields = element.as_table()) {
        read_table(*fields, name, MissingKeys::kAreErrors, row, problems);
      } else {
        problems.push_back({element.source().begin.line, name + ": expected tables in the list"});
      }
      values.push_back(row.value);
    }
  }
  table->erase(key);
}

void sort_by_begin(auto& intervals) {
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const auto& a, const auto& b) { return a.begin_s < b.begin_s; });
}

template <class Table>
Table read_section(const toml::table& document, std::string_view section,
                   std::vector<TomlProblem>& problems) {
  Table values{};
  if (const toml::table* table = document.get_as<toml::table>(section)) {
    read_table(*table, section, MissingKeys::kAreErrors, values, problems);
  } else {
    problems.push_back({0, fmt::format("no table [{}]; expected one", section)});
  }
  return values;
}

// The lists of the document, taken out of it.
void take_lists(toml::table& document, SimulationTruth& truth, std::vector<TomlProblem>& problems) {
  const toml::table* lidar_table = document.get_as<toml::table>("lidar");
  if (lidar_table != nullptr && lidar_table->contains("degenerate")) {
    truth.degenerate.emplace();
    take_rows<DegenerateRow>(document, "lidar", "degenerate", *truth.degenerate, problems);
    take_rows<BlindRow>(document, "lidar", "blind", *truth.degenerate, problems);
    sort_by_begin(*truth.degenerate);
  }
  take_rows<BiasRow>(document, "imu", "bias", truth.imu_bias, problems);
  take_rows<SlipRow>(document, "wheels", "slips", truth.slips, problems);
  const std::size_t num_events = truth.slips.size();
  take_rows<SlipRow>(document, "wheels", "grip_slips", truth.slips, problems);
  for (std::size_t i = num_events; i < truth.slips.size(); ++i) {
    truth.slips[i].cause = SlipCause::kGrip;
  }
  sort_by_begin(truth.slips);
}

}  // namespace

std::string truth_toml(const SimulationTruth& truth) {
  const Pose2& start = truth.T_world_base_start;
  const ImuErrors& imu = truth.imu;
  std::vector<SlipInterval> events, grip_slips;
  for (const SlipInterval& slip : truth.slips) {
    (slip.cause == SlipCause::kGrip ? grip_slips : events).push_back(slip);
  }
  std::string text =
      world_toml(truth.world) +
      table_text("start", StartTable{start.x_m(), start.y_m(), start.theta_rad()}) +
      table_text("wheels", WheelTable{truth.wheels.left_scale, truth.wheels.right_scale}) +
      rows_text<SlipRow>("slips", events) + rows_text<SlipRow>("grip_slips", grip_slips) +
      table_text("imu",
                 ImuTable{imu.gyro_bias_radps, imu.accel_bias_x_mps2, imu.accel_bias_y_mps2});
  if (!truth.imu_bias.empty()) text += rows_text<BiasRow>("bias", truth.imu_bias);
  text += table_text("lidar", LidarTable{truth.range_max_m, truth.range_sigma_m});
  if (truth.degenerate) text += degenerate_text(*truth.degenerate);
  return text + table_text("errors",
                           ErrorsTable{truth.wheels.track_ratio, imu.gyro_scale, imu.accel_scale_x,
                                       imu.accel_scale_y, imu.misalignment_rad,
                                       truth.lidar_time_offset_s, truth.imu_time_offset_s});
}

Result<SimulationTruth> read_truth(const std::filesystem::path& path) {
  Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  std::vector<TomlProblem> problems;
  SimulationTruth truth;
  take_lists(*document, truth, problems);
  if (const toml::table* world = document->get_as<toml::table>("world")) {
    truth.world = read_world_table(*world, problems);
  } else {
    problems.push_back({0, "no table [world]; expected one"});
  }
  const auto start = read_section<StartTable>(*document, "start", problems);
  const auto wheels = read_section<WheelTable>(*document, "wheels", problems);
  const auto imu = read_section<ImuTable>(*document, "imu", problems);
  const auto lidar = read_section<LidarTable>(*document, "lidar", problems);
  ErrorsTable errors;
  if (document->contains("errors")) {
    errors = read_section<ErrorsTable>(*document, "errors", problems);
  }
  find_unknown_keys(*document, "", {"world", "start", "wheels", "imu", "lidar", "errors"},
                    problems);
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));

  truth.T_world_base_start = Pose2(start.x_m, start.y_m, start.yaw_rad);
  truth.wheels = {wheels.left_scale, wheels.right_scale, errors.track_ratio};
  truth.imu = {imu.gyro_bias_radps,    imu.accel_bias_x_mps2, imu.accel_bias_y_mps2,
               errors.gyro_scale,      errors.accel_scale_x,  errors.accel_scale_y,
               errors.misalignment_rad};
  truth.lidar_time_offset_s = errors.lidar_time_offset_s;
  truth.imu_time_offset_s = errors.imu_time_offset_s;
  truth.range_max_m = lidar.range_max_m;
  truth.range_sigma_m = lidar.range_sigma_m;
  return truth;
}

}  // namespace corridor::simulation
