#include "datasets/simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/simulation/imu_model.hpp"
#include "datasets/simulation/lidar_model.hpp"
#include "datasets/simulation/message_path.hpp"
#include "datasets/simulation/observability.hpp"
#include "datasets/simulation/people.hpp"
#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/route.hpp"
#include "datasets/simulation/slips.hpp"
#include "datasets/simulation/wheel_model.hpp"
#include "slam/core/expect.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

// From the base to the nearest wall, anywhere on the true path: half a robot's width.
constexpr double kLeastRoom_m = 0.2;
// Of the true biases in the sidecar.
constexpr double kBiasRate_hz = 1;

World draw_world(const Scenario& scenario, Rng rng) {
  if (!scenario.world.corridor) return scenario.world;
  const DrawParams& params = scenario.draw;
  CorridorShape drawn = *scenario.world.corridor;
  drawn.a_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  drawn.b_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  drawn.c_m *= 1 + rng.uniform(-params.length_spread, params.length_spread);
  const double alpha_spread_rad = params.alpha_spread_deg * kRadPerDeg;
  drawn.alpha_rad += rng.uniform(-alpha_spread_rad, alpha_spread_rad);
  return make_corridor(drawn);
}

SimulationTruth draw_truth(const Scenario& scenario, const Drive& drive, const World& world,
                           const Rng& rng) {
  SimulationTruth truth;
  truth.world = world;
  truth.T_world_base_start = drive.states.front().T_world_base;
  truth.wheels = draw_wheel_errors(scenario.wheels, rng.stream("wheels"));
  truth.imu = draw_imu_errors(scenario.imu, rng.stream("imu"));
  truth.slips = drawn_slips(scenario.slip, drive.duration_s(), rng.stream("slips"));
  append_friction_slips(drive, truth.slips);
  const double lidar_error_s =
      rng.stream("lidar clock").normal(0, scenario.lidar.time_offset_sigma_s);
  truth.lidar_time_offset_s = scenario.lidar.time_offset_s + lidar_error_s;
  truth.imu_time_offset_s = rng.stream("imu clock").normal(0, scenario.imu.time_offset_sigma_s);
  truth.range_max_m = scenario.lidar.range_max_m;
  truth.range_sigma_m = scenario.lidar.range_sigma_m;
  return truth;
}

// A log says that the robot drove: to its end, and not through walls.
Result<void> check_drive(const Drive& drive, const DrivePlan& plan, const World& world,
                         const std::string& name) {
  std::vector<Eigen::Vector2d> path_m;
  for (const DriveState& state : drive.states) path_m.push_back(state.T_world_base.translation_m());
  const std::vector<double> needed_m(path_m.size(), kLeastRoom_m);
  if (const auto spot = tight_spot(world, path_m, needed_m)) {
    return fail(ErrorCode::kInvalid,
                fmt::format("after {:.1f} s the drive passes {}",
                            static_cast<double>(spot->leg) * drive.step_s, to_text(*spot)),
                name);
  }
  if (drive.is_complete) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("waypoint {} of {} is not reached within {:.0f} s", drive.num_reached + 1,
                          plan.waypoints_m.size(), drive.duration_s()),
              name, "[drive] limits with which the robot can follow its route");
}

// Lets the three sensors watch the drive, step by step.
class Recorder {
 public:
  Recorder(const Scenario& scenario, const Drive& drive, const Rng& rng, Simulated& simulated)
      : scenario_(scenario),
        drive_(drive),
        rng_(rng),
        simulated_(simulated),
        lidar_(simulated.world, scenario.lidar),
        people_(scenario.people, route_of(simulated.world, scenario.drive), rng.stream("people")),
        encoders_(scenario.wheels, simulated.log.robot.wheels, simulated.truth.wheels,
                  rng.stream("wheels").stream("noise")),
        imu_(scenario.imu, simulated.truth.imu, drive.step_s, rng.stream("imu")),
        lidar_path_(scenario.lidar.message, scenario.outages, simulated.truth.lidar_time_offset_s,
                    rng.stream("lidar messages")),
        wheel_path_(scenario.wheels.message, scenario.outages, 0, rng.stream("wheel messages")),
        imu_path_(scenario.imu.message, scenario.outages, simulated.truth.imu_time_offset_s,
                  rng.stream("imu messages")) {}

  // Whether any scan's beam has met a wall: else the route lies outside of its world.
  bool record() {
    const double rate_hz = scenario_.imu.rate_hz;
    const std::size_t wheel_steps = steps_per_sample(rate_hz, scenario_.wheels.rate_hz);
    const std::size_t scan_steps = steps_per_sample(rate_hz, scenario_.lidar.rate_hz);
    const std::size_t bias_steps = steps_per_sample(rate_hz, kBiasRate_hz);
    for (std::size_t k = 1; k < drive_.states.size(); ++k) {
      const DriveState& from = drive_.states[k - 1];
      const DriveState& to = drive_.states[k];
      const Timestamp moment = timestamp_from_seconds(static_cast<double>(k) / rate_hz);
      // The interval of a step is judged at its middle.
      const double middle_s = (static_cast<double>(k) - 0.5) * drive_.step_s;
      encoders_.advance(from, to, drive_.step_s, event_ratio_at(simulated_.truth.slips, middle_s));
      if (k % wheel_steps == 0) {
        if (const auto stamp = wheel_path_.stamp_of(moment)) add(encoders_.sample(*stamp));
      }
      ImuSample reading = imu_.measure(from, to, moment);
      if (k % bias_steps == 0 && imu_.has_varying_bias()) {
        simulated_.truth.imu_bias.push_back({to_seconds(moment), imu_.bias()});
      }
      if (const auto stamp = imu_path_.stamp_of(moment)) {
        reading.stamp = *stamp;
        add(reading);
      }
      if (k % scan_steps == 0) take_scan(k, k / scan_steps, moment);
    }
    std::stable_sort(
        simulated_.log.events.begin(), simulated_.log.events.end(),
        [](const SensorEvent& a, const SensorEvent& b) { return stamp_of(a) < stamp_of(b); });
    simulated_.truth.degenerate = degenerate_.intervals();
    return has_seen_walls_;
  }

 private:
  static std::size_t steps_per_sample(double imu_rate_hz, double rate_hz) {
    return static_cast<std::size_t>(std::llround(imu_rate_hz / rate_hz));
  }

  void add(SensorEvent event) { simulated_.log.events.push_back(std::move(event)); }

  void take_scan(std::size_t step_index, std::size_t scan_index, Timestamp moment) {
    // A sweep that the end of the drive cuts short is not recorded.
    const double end_s =
        static_cast<double>(step_index) * drive_.step_s + scenario_.lidar.scan_duration_s;
    if (end_s > drive_.duration_s() + 1e-9) return;
    const std::optional<Timestamp> stamp = lidar_path_.stamp_of(moment);
    if (!stamp) return;
    const Pose2& T_world_base = drive_.states[step_index].T_world_base;
    const Sweep sweep = lidar_.sweep(
        [&](double time_s) { return pose_after(step_index, time_s); },
        people_.at(static_cast<double>(step_index) * drive_.step_s, T_world_base.translation_m()));
    LaserScan scan = lidar_.measure(sweep, rng_.stream("lidar").stream(std::uint64_t{scan_index}));
    scan.stamp = *stamp;
    add(std::move(scan));
    const auto free = free_direction(sweep.hits);
    has_seen_walls_ = has_seen_walls_ || !free || free->direction_rad;
    degenerate_.add(*stamp, free);
    const bool is_later = simulated_.log.truth->append({*stamp, T_world_base, std::nullopt});
    CORRIDOR_ENSURE(is_later);
  }

  // Pose a time after a step, on the arc between the two states around it.
  Pose2 pose_after(std::size_t step_index, double time_s) const {
    const double steps = time_s / drive_.step_s;
    const auto whole = static_cast<std::size_t>(steps);
    const std::size_t from = std::min(step_index + whole, drive_.states.size() - 1);
    const std::size_t to = std::min(from + 1, drive_.states.size() - 1);
    const Pose2& T_world_from = drive_.states[from].T_world_base;
    const double share = steps - static_cast<double>(whole);
    if (share == 0 || from == to) return T_world_from;
    return T_world_from.plus(share * drive_.states[to].T_world_base.minus(T_world_from));
  }

  const Scenario& scenario_;
  const Drive& drive_;
  const Rng& rng_;
  Simulated& simulated_;
  LidarModel lidar_;
  People people_;
  WheelEncoders encoders_;
  ImuModel2d imu_;
  MessagePath lidar_path_, wheel_path_, imu_path_;
  DegenerateIntervals degenerate_;
  bool has_seen_walls_ = false;
};

}  // namespace

Result<Simulated> simulate(const Scenario& scenario, std::uint64_t seed) {
  CORRIDOR_EXPECT(violations(scenario).empty());
  const Rng rng(seed);
  Simulated simulated;
  simulated.world = draw_world(scenario, rng.stream("world"));
  const DrivePlan plan = draw_plan(simulated.world, scenario.drive, rng.stream("path"));
  const Drive drive = drive_along(plan, scenario.drive, 1 / scenario.imu.rate_hz);
  const std::string name = fmt::format("{}-s{}", scenario.name, seed);
  if (const Result<void> driven = check_drive(drive, plan, simulated.world, name); !driven) {
    return tl::make_unexpected(driven.error());
  }
  simulated.truth = draw_truth(scenario, drive, simulated.world, rng);
  simulated.log.robot = nominal_robot(scenario);
  simulated.log.provenance = {
      .name = name, .source = "simulated", .format = "simulation", .notes = {}};
  simulated.log.truth.emplace();
  const bool has_seen_walls = Recorder(scenario, drive, rng, simulated).record();
  if (simulated.log.truth->empty()) {
    return fail(ErrorCode::kInvalid,
                fmt::format("no scan in a drive of {:.3g} s", drive.duration_s()), name,
                "a drive long enough for one");
  }
  if (!has_seen_walls) {
    return fail(
        ErrorCode::kInvalid,
        fmt::format("none of {} scans sees a wall on the way from ({:.3g}, {:.3g}) m",
                    simulated.log.num_scans(), simulated.truth.T_world_base_start.x_m(),
                    simulated.truth.T_world_base_start.y_m()),
        name,
        fmt::format("a route from which walls are seen, at most lidar.range_max_m = {} m away",
                    scenario.lidar.range_max_m));
  }
  return simulated;
}

}  // namespace corridor::simulation
