#include "bench/runner/drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "bench/runner/process_clock.hpp"

namespace corridor::runner {
namespace {

using results::CaseStatus;

void end_with(Drive& run, CaseStatus status, std::string message) {
  run.status = status;
  run.status_message = std::move(message);
}

bool is_finite(const GridMap& map) {
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      const GridCell& cell = map.at(column, row);
      if (!std::isfinite(cell.log_odds) || !std::isfinite(cell.hits)) return false;
    }
  }
  return true;
}

// False: the run is over.
bool keep_report(const StepReport& report, const SensorEvent& event, Drive& run) {
  if (!std::holds_alternative<LaserScan>(event)) return true;
  if (report.is_slip_detected || report.is_degenerate) {
    run.health.push_back({stamp_of(event), report.is_slip_detected, report.is_degenerate});
  }
  if (!report.T_map_base) return true;
  if (run.online.append({stamp_of(event), *report.T_map_base, std::nullopt})) return true;
  end_with(run, CaseStatus::kDiverged,
           fmt::format("the pose at {:.3f} s is not finite", to_seconds(stamp_of(event))));
  return false;
}

// False: the run is over. `last_scan_status` is the report of the last scan.
bool step_all(SlamSystem& system, const SensorLog& log, Drive& run, StepStatus& last_scan_status) {
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    const SensorEvent& event = log.events[i];
    system.stage_clock().begin_step();
    const Result<StepReport> report = system.step(event);
    system.stage_clock().end_step();
    const bool is_scan = std::holds_alternative<LaserScan>(event);
    if (is_scan) run.scan_steps_s.push_back(system.stage_clock().step_samples_s().back());
    if (!report) {
      end_with(run, CaseStatus::kFailed,
               fmt::format("event {} at {:.3f} s: {}", i, to_seconds(stamp_of(event)),
                           report.error().to_line()));
      return false;
    }
    if (is_scan) last_scan_status = report->status;
    if (!keep_report(*report, event, run)) return false;
  }
  return true;
}

void finish(SlamSystem& system, StepStatus last_scan_status, Drive& run) {
  system.stage_clock().begin_step(Stage::kFinish);
  Result<SlamEstimate> estimate = system.finish();
  system.stage_clock().end_step();
  if (!estimate) {
    end_with(run, CaseStatus::kFailed, "finish: " + estimate.error().to_line());
    return;
  }
  run.estimate = std::move(*estimate);
  if (run.estimate->map && !is_finite(*run.estimate->map)) {
    end_with(run, CaseStatus::kDiverged, "the map holds values that are not finite");
  } else if (last_scan_status == StepStatus::kLost) {
    end_with(run, CaseStatus::kDiverged, "the system reported at the last scan that it is lost");
  }
}

}  // namespace

Drive drive(SlamSystem& system, const SensorLog& log) {
  Drive run;
  StepStatus last_scan_status = StepStatus::kNothingToDo;
  const MemoryWatch memory;
  Stopwatch clock;
  clock.start();
  if (step_all(system, log, run, last_scan_status)) finish(system, last_scan_status, run);
  clock.stop();
  run.cpu_s = clock.cpu_s();
  run.peak_rss_mib = memory.peak_mib();
  run.peak_growth_mib = memory.growth_mib();
  const std::vector<double>& steps_s = system.stage_clock().step_samples_s();
  run.wall_s = std::accumulate(steps_s.begin(), steps_s.end(), 0.0);
  return run;
}

}  // namespace corridor::runner
