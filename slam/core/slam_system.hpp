// The one interface between a SLAM system and whoever drives it.
// A system gets parameters, calibration and a random generator when it is built, then only events
// in time order. It reads no file and prints nothing; its clock measures stages and decides
// nothing.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/grid_map.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"
#include "slam/core/stage_clock.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor {

enum class StepStatus {
  kNothingToDo,  // the event was kept or ignored; no new pose is claimed
  kTracked,      // a pose was given
  kLost,         // a pose is given, but the system itself no longer believes it
};

struct StepReport {
  StepStatus status = StepStatus::kNothingToDo;
  Timestamp stamp;
  // The pose the system would have told its robot at this moment. Given for every scan event.
  std::optional<Pose2> T_map_base;
  bool is_key_scan = false;
  // Health flags, where the system has them.
  std::optional<bool> is_slip_detected;
  std::optional<bool> is_degenerate;
};

struct SlamEstimate {
  Trajectory trajectory;  // smoothed, one pose per scan; map frame = base frame of the first scan
  std::optional<GridMap> map;  // none for systems without one
  // Named totals that explain the run: "key_scans", "loop_closures", "resamplings", "factors".
  std::map<std::string, double> counters;
};

class SlamSystem {
 public:
  SlamSystem() = default;
  SlamSystem(const SlamSystem&) = delete;
  SlamSystem& operator=(const SlamSystem&) = delete;
  virtual ~SlamSystem() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  // Events in the order of the log. An Error means that the event itself cannot be used; one with a
  // defect (sensor_log.hpp) or out of order never reaches the system.
  Result<StepReport> step(const SensorEvent& event);
  // Called once, after the last event.
  virtual Result<SlamEstimate> finish() = 0;

  // Stage times of this run.
  [[nodiscard]] StageClock& stage_clock() { return stage_clock_; }

 private:
  // An event without a defect; stamps never decrease, those of scans increase.
  virtual Result<StepReport> on_event(const SensorEvent& event) = 0;

  std::optional<Timestamp> last_stamp_, last_scan_stamp_;
  StageClock stage_clock_;
};

}  // namespace corridor
