#include "datasets/simulation/scenario.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/simulation/scenario_sections.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {

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
  if (scenario.world.corridor && violations(*scenario.world.corridor).empty()) {
    scenario.world = make_corridor(*scenario.world.corridor);
  }
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

std::vector<ParamRow> scenario_table(const Scenario& scenario) {
  std::vector<ParamRow> rows;
  Scenario copy = scenario;
  for_each_section(copy, [&](const char* section, auto& params) {
    for (ParamRow& row : param_table(params)) {
      row.name.insert(0, fmt::format("{}.", section));
      rows.push_back(std::move(row));
    }
  });
  return rows;
}

RobotModel nominal_robot(const Scenario& scenario) {
  RobotModel robot;
  robot.name = "corridor robot";
  robot.wheels.track_m = scenario.wheels.track_m;
  robot.wheels.left_m_per_tick = scenario.wheels.m_per_tick;
  robot.wheels.right_m_per_tick = scenario.wheels.m_per_tick;
  const double speed_mps = 0.5 * (scenario.drive.speed_min_mps + scenario.drive.speed_max_mps);
  robot.wheels.sigma_m_per_sqrt_m = scenario.wheels.noise_m_per_sqrt_m(speed_mps);
  robot.lidar.range_min_m = scenario.lidar.range_min_m;
  robot.lidar.range_max_m = scenario.lidar.range_max_m;
  robot.lidar.range_sigma_m = stated_range_sigma_m(scenario.lidar);
  robot.lidar.T_base_lidar = T_base_lidar(scenario.lidar);
  robot.lidar.scan_duration_s = scenario.lidar.scan_duration_s;
  robot.lidar.time_offset_s = scenario.lidar.time_offset_s;
  const ImuParams& imu = scenario.imu;
  robot.imu.T_base_imu = Pose2(imu.x_m, imu.y_m, imu.yaw_deg * kRadPerDeg);
  robot.imu.rate_hz = imu.rate_hz;
  robot.imu.gyro_noise_radps = imu.gyro_noise_radps();
  robot.imu.accel_noise_mps2 = imu.accel_noise_mps2();
  if (imu.gyro_walk_radps_rts > 0) {
    robot.imu.gyro_bias_walk_radps_sqrt_s = imu.gyro_walk_radps_rts;
  }
  if (imu.accel_walk_mps2_rts > 0) {
    robot.imu.accel_bias_walk_mps2_sqrt_s = imu.accel_walk_mps2_rts;
  }
  return robot;
}

}  // namespace corridor::simulation
