// Drives a scenario's robot through its corridor and records what its sensors say.
// Every drawn number comes from a stream named by its cause, so that changing one sensor leaves the
// drive and the other sensors as they were.
#pragma once

#include <cstdint>
#include <string>

#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/truth.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::simulation {

struct Simulated {
  // Events at equal stamps: wheels, IMU, scan. log.robot is the nominal calibration, without the
  // drawn errors. log.truth = T_world_base at each scan.
  SensorLog log;
  World world;
  SimulationTruth truth;
};

// Deterministic: the same scenario and seed give the same bytes. Requires violations(scenario) to
// be empty, which read_scenario() and with_overrides() guarantee. An Error where the drive that the
// seed gives does not reach its end, comes too near to a wall, or is over before the first scan.
Result<Simulated> simulate(const Scenario& scenario, std::uint64_t seed);

// The text of LOG.truth.toml.
inline std::string truth_toml(const Simulated& simulated) { return truth_toml(simulated.truth); }

}  // namespace corridor::simulation
