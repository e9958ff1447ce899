#include "datasets/simulation/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/simulation/toml_input.hpp"

namespace corridor::simulation {
namespace {

// Calls visitor(section name, parameter struct) for each table of a scenario file.
template <class Visitor>
void for_each_section(Scenario& scenario, Visitor&& visitor) {
  WorldParams world = to_params(scenario.world);
  visitor("world", world);
  scenario.world = to_shape(world);
  visitor("lidar", scenario.lidar);
  visitor("wheels", scenario.wheels);
  visitor("imu", scenario.imu);
  visitor("drive", scenario.drive);
  visitor("slip", scenario.slip);
  visitor("draw", scenario.draw);
}

std::vector<TomlProblem> read_document(const toml::table& document, Scenario& scenario) {
  std::vector<TomlProblem> problems;
  std::vector<std::string> known{"name", "description"};
  const auto read_text = [&](const char* key, std::string& text) {
    const toml::node* node = document.get(key);
    if (node != nullptr && !read_value(*node, text)) {
      problems.push_back(
          {node->source().begin.line, fmt::format("{} has another type; expected text", key)});
    }
  };
  read_text("name", scenario.name);
  read_text("description", scenario.description);
  for_each_section(scenario, [&](const char* section, auto& params) {
    known.emplace_back(section);
    const toml::node* node = document.get(section);
    if (node == nullptr) return;
    if (const toml::table* table = node->as_table()) {
      read_table(*table, section, MissingKeys::kKeepDefault, params, problems);
    } else {
      problems.push_back({node->source().begin.line,
                          fmt::format("{} is not a table; expected [{}]", section, section)});
    }
  });
  find_unknown_keys(document, "", known, problems);
  return problems;
}

// "lidar.range_max_m = 3: expected ..." stands in the line of that key.
std::uint32_t line_of_violation(const toml::table& document, std::string_view violation) {
  const std::size_t point = violation.find('.');
  const std::size_t space = violation.find(' ');
  if (point == std::string_view::npos || space == std::string_view::npos || point > space) return 0;
  return line_of(document, violation.substr(0, point),
                 violation.substr(point + 1, space - point - 1));
}

}  // namespace

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  const Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  Scenario scenario;
  scenario.name = path.stem().string();
  std::vector<TomlProblem> problems = read_document(*document, scenario);
  for (std::string& line : violations(scenario)) {
    const std::uint32_t line_number = line_of_violation(*document, line);
    problems.push_back({line_number, std::move(line)});
  }
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));
  return scenario;
}

Result<Scenario> with_overrides(Scenario scenario, const ParamValues& overrides,
                                std::string_view where) {
  std::vector<std::string> problems;
  ParamValues unused = overrides;
  for_each_section(scenario, [&](const char* section, auto& params) {
    std::remove_reference_t<decltype(params)>::visit(
        params, [&](const ParamInfo& info, auto& field) {
          const std::string key = fmt::format("{}.{}", section, info.name);
          const auto found = overrides.find(key);
          if (found == overrides.end()) return;
          unused.erase(key);
          if (!detail::from_text(found->second, field)) {
            problems.push_back(
                fmt::format("{} = \"{}\": expected {}", key, found->second,
                            detail::type_name<std::remove_reference_t<decltype(field)>>()));
          }
        });
  });
  for (const auto& [key, value] : unused) problems.push_back("unknown scenario key " + key);
  for (std::string& line : violations(scenario)) problems.push_back(std::move(line));
  if (problems.empty()) return scenario;
  std::string what = problems.front();
  for (std::size_t i = 1; i < problems.size(); ++i) what += "; " + problems[i];
  return fail(ErrorCode::kInvalid, std::move(what), std::string(where));
}

ParamValues scenario_values(const Scenario& scenario) {
  ParamValues values{{"name", scenario.name}, {"description", scenario.description}};
  Scenario copy = scenario;
  for_each_section(copy, [&](const char* section, auto& params) {
    for (const auto& [key, value] : param_values(params)) {
      values.emplace(fmt::format("{}.{}", section, key), value);
    }
  });
  return values;
}

std::vector<std::filesystem::path> list_scenarios() {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(CORRIDOR_SCENARIO_DIR, error)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<std::filesystem::path> find_scenario(const std::string& name_or_path) {
  std::error_code error;
  std::string known;
  for (const std::filesystem::path& path : list_scenarios()) {
    if (path.stem() == name_or_path) return path;
    known += (known.empty() ? "" : " ") + path.stem().string();
  }
  if (std::filesystem::is_regular_file(name_or_path, error)) {
    return std::filesystem::path(name_or_path);
  }
  return fail(ErrorCode::kNotFound, "no such scenario", name_or_path, "a file or one of " + known);
}

RobotModel nominal_robot(const Scenario& scenario) {
  RobotModel robot;
  robot.name = "corridor robot";
  robot.wheels.track_m = scenario.wheels.track_m;
  robot.wheels.left_m_per_tick = scenario.wheels.m_per_tick;
  robot.wheels.right_m_per_tick = scenario.wheels.m_per_tick;
  // White noise of `noise_ratio` on every step of length d adds (noise_ratio * d)^2 per d of path:
  // noise_ratio * sqrt(d) per root metre, at the mean cruising speed.
  const double speed_mps = 0.5 * (scenario.drive.speed_min_mps + scenario.drive.speed_max_mps);
  robot.wheels.sigma_m_per_sqrt_m =
      scenario.wheels.noise_ratio * std::sqrt(speed_mps / scenario.imu.rate_hz);
  robot.lidar.range_min_m = scenario.lidar.range_min_m;
  robot.lidar.range_max_m = scenario.lidar.range_max_m;
  robot.lidar.range_sigma_m = scenario.lidar.range_sigma_m;
  robot.imu.rate_hz = scenario.imu.rate_hz;
  robot.imu.gyro_noise_radps = scenario.imu.gyro_noise_radps;
  robot.imu.accel_noise_mps2 = scenario.imu.accel_noise_mps2;
  return robot;
}

}  // namespace corridor::simulation
