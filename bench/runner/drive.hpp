// Drives a system through a log, as a robot would: events in order, poses kept as they were given,
// the clock running in step() and finish() only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/results/run_result.hpp"
#include "slam/core/sensor_log.hpp"
#include "slam/core/slam_system.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::runner {

// What a system said about its own health at one scan.
struct HealthSample {
  Timestamp stamp;
  std::optional<bool> is_slip_detected;
  std::optional<bool> is_degenerate;
};

struct Drive {
  results::CaseStatus status = results::CaseStatus::kOk;  // ok, diverged or failed
  std::string status_message;
  Trajectory online;                      // the poses given at the scans
  std::optional<SlamEstimate> estimate;   // none after a failure
  std::vector<HealthSample> health;       // only scans with at least one flag
  std::vector<double> scan_steps_s;       // step() of each scan event
  double wall_s = 0;                      // all step() and finish()
  double cpu_s = 0;                       // of the process meanwhile
  std::optional<double> peak_rss_mib;     // of the process meanwhile
  std::optional<double> peak_growth_mib;  // of that, beyond what it had before
};

Drive drive(SlamSystem& system, const SensorLog& log);

}  // namespace corridor::runner
