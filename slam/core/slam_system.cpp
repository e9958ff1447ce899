#include "slam/core/slam_system.hpp"

namespace corridor {

Result<StepReport> SlamSystem::step(const SensorEvent& event) {
  if (const auto what = defect_of(event)) return fail(ErrorCode::kInvalid, *what);
  const Timestamp stamp = stamp_of(event);
  if (last_stamp_ && stamp < *last_stamp_) {
    return fail(ErrorCode::kInvalid, "stamp steps back", {}, "events in order of time");
  }
  if (std::holds_alternative<LaserScan>(event)) {
    if (last_scan_stamp_ && stamp <= *last_scan_stamp_) {
      return fail(ErrorCode::kInvalid, "scan stamp does not increase", {},
                  "a stamp later than the last scan's");
    }
    last_scan_stamp_ = stamp;
  }
  last_stamp_ = stamp;
  return on_event(event);
}

}  // namespace corridor
