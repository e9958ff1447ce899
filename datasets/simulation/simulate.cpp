#include "datasets/simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/observability.hpp"
#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/simulated_sensors.hpp"
#include "slam/core/expect.hpp"

namespace corridor::simulation {
namespace {

CorridorShape draw_shape(const CorridorShape& shape, const DrawParams& params, Rng rng) {
  CorridorShape drawn = shape;
  drawn.a_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  drawn.b_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  drawn.c_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  const double alpha_spread_rad = params.alpha_spread_deg * std::numbers::pi / 180;
  drawn.alpha_rad += rng.uniform(-alpha_spread_rad, alpha_spread_rad);
  return drawn;
}

// Uniform over all ways to place the slips one after the other in the drive: sorted uniform points
// of the time that the slips leave free.
std::vector<SlipInterval> draw_slips(const SlipParams& params, double drive_s, Rng rng) {
  const double free_s = drive_s - params.num_slips * params.duration_s;
  CORRIDOR_EXPECT(free_s >= 0);  // violations(scenario) says whether the drive is long enough
  std::vector<double> begins_s;
  begins_s.reserve(static_cast<std::size_t>(params.num_slips));
  for (int i = 0; i < params.num_slips; ++i) begins_s.push_back(rng.uniform(0, free_s));
  std::sort(begins_s.begin(), begins_s.end());
  std::vector<SlipInterval> slips;
  for (const double begin_s : begins_s) {
    const double shifted_s = begin_s + static_cast<double>(slips.size()) * params.duration_s;
    slips.push_back({shifted_s, shifted_s + params.duration_s, params.ratio});
  }
  return slips;
}

double spin_ratio_at(const std::vector<SlipInterval>& slips, double time_s) {
  for (const SlipInterval& slip : slips) {
    if (time_s >= slip.begin_s && time_s < slip.end_s) return slip.ratio;
  }
  return 0;
}

Timestamp stamp_of_step(std::size_t step_index, double rate_hz) {
  return timestamp_from_seconds(static_cast<double>(step_index) / rate_hz);
}

std::size_t steps_per_sample(double imu_rate_hz, double rate_hz) {
  return static_cast<std::size_t>(std::llround(imu_rate_hz / rate_hz));
}

SimulationTruth draw_truth(const Scenario& scenario, const Drive& drive, const CorridorShape& shape,
                           const Rng& rng) {
  const WheelScales scales =
      draw_wheel_scales(scenario.wheels, rng.stream("wheels").stream("scale"));
  const ImuBias bias = draw_imu_bias(scenario.imu, rng.stream("imu").stream("bias"));
  SimulationTruth truth;
  truth.world = shape;
  truth.T_world_base_start = drive.states.front().T_world_base;
  truth.left_scale = scales.left;
  truth.right_scale = scales.right;
  truth.slips = draw_slips(scenario.slip, drive.duration_s(), rng.stream("slips"));
  truth.gyro_bias_radps = bias.gyro_radps;
  truth.accel_bias_x_mps2 = bias.accel_x_mps2;
  truth.accel_bias_y_mps2 = bias.accel_y_mps2;
  truth.range_max_m = scenario.lidar.range_max_m;
  truth.range_sigma_m = scenario.lidar.range_sigma_m;
  return truth;
}

// Lets the three sensors watch the drive, step by step.
void record(const Scenario& scenario, const Drive& drive, const Rng& rng, Simulated& simulated) {
  const SimulationTruth& truth = simulated.truth;
  const double rate_hz = scenario.imu.rate_hz;
  const std::size_t wheel_steps = steps_per_sample(rate_hz, scenario.wheels.rate_hz);
  const std::size_t scan_steps = steps_per_sample(rate_hz, scenario.lidar.rate_hz);
  const RayCaster caster(simulated.world);
  const ImuBias bias{truth.gyro_bias_radps, truth.accel_bias_x_mps2, truth.accel_bias_y_mps2};
  WheelEncoders encoders(scenario.wheels, simulated.log.robot.wheels,
                         {truth.left_scale, truth.right_scale},
                         rng.stream("wheels").stream("noise"));
  Rng imu_noise = rng.stream("imu").stream("noise");
  DegenerateIntervals degenerate;
  Trajectory trajectory;

  for (std::size_t k = 1; k < drive.states.size(); ++k) {
    const DriveState& from = drive.states[k - 1];
    const DriveState& to = drive.states[k];
    const Timestamp stamp = stamp_of_step(k, rate_hz);
    // The interval of a step is judged at its middle.
    const double middle_s = (static_cast<double>(k) - 0.5) * drive.step_s;
    encoders.advance(from, to, drive.step_s, spin_ratio_at(truth.slips, middle_s));
    if (k % wheel_steps == 0) simulated.log.events.emplace_back(encoders.sample(stamp));
    simulated.log.events.emplace_back(
        measure_imu(from, to, drive.step_s, stamp, bias, scenario.imu, imu_noise));
    if (k % scan_steps != 0) continue;
    const auto hits = cast_beams(caster, to.T_world_base, scenario.lidar);
    simulated.log.events.emplace_back(measure_scan(
        hits, stamp, scenario.lidar, rng.stream("lidar").stream(std::uint64_t{k / scan_steps})));
    degenerate.add(stamp, degenerate_direction_rad(hits, simulated.world));
    CORRIDOR_ENSURE(trajectory.append({stamp, to.T_world_base, std::nullopt}));
  }
  simulated.log.truth = std::move(trajectory);
  simulated.truth.degenerate = degenerate.intervals();
}

}  // namespace

Simulated simulate(const Scenario& scenario, std::uint64_t seed) {
  CORRIDOR_EXPECT(violations(scenario).empty());
  const Rng rng(seed);
  const CorridorShape shape = draw_shape(scenario.world, scenario.draw, rng.stream("world"));
  const DrivePlan plan = draw_plan(shape, scenario.drive, rng.stream("path"));
  const Drive drive = drive_along(plan, scenario.drive, 1 / scenario.imu.rate_hz);

  Simulated simulated;
  simulated.world = make_corridor(shape);
  simulated.truth = draw_truth(scenario, drive, shape, rng);
  simulated.log.robot = nominal_robot(scenario);
  simulated.log.provenance = {.name = fmt::format("{}-s{}", scenario.name, seed),
                              .source = "simulated",
                              .format = "simulation",
                              .notes = {}};
  if (!drive.is_complete) {
    simulated.log.provenance.notes.emplace_back("the drive ended before its last waypoint");
  }
  record(scenario, drive, rng, simulated);
  return simulated;
}

}  // namespace corridor::simulation
