#include "datasets/formats/lidar_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::formats {
namespace {

// Rawlogs round stamps to 100 ns, text with six decimals to 500 ns.
constexpr std::int64_t kSameStamp_ns = 1'000;

std::vector<Timestamp> scan_stamps(const SensorLog& log) {
  std::vector<Timestamp> stamps;
  for (const SensorEvent& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) stamps.push_back(scan->stamp);
  }
  return stamps;
}

// `sorted` has a stamp within kSameStamp_ns.
bool has_stamp(const std::vector<Timestamp>& sorted, Timestamp stamp) {
  const auto next =
      std::lower_bound(sorted.begin(), sorted.end(), Timestamp{stamp.nanoseconds - kSameStamp_ns});
  return next != sorted.end() && next->nanoseconds <= stamp.nanoseconds + kSameStamp_ns;
}

// At least half of `stamps` are those of scans.
bool are_of_scans(const std::vector<Timestamp>& stamps, const std::vector<Timestamp>& scans) {
  const auto num_shared = std::count_if(
      stamps.begin(), stamps.end(), [&scans](Timestamp stamp) { return has_stamp(scans, stamp); });
  return 2 * static_cast<std::size_t>(num_shared) >= stamps.size();
}

Trajectory moved(const Trajectory& trajectory, double seconds) {
  Trajectory result;
  for (TrajectoryPose pose : trajectory.poses()) {
    pose.stamp = add_seconds(pose.stamp, seconds);
    const bool is_appended = result.append(std::move(pose));
    CORRIDOR_ENSURE(is_appended);  // all stamps move by the same whole nanoseconds
  }
  return result;
}

std::vector<Timestamp> stamps_of(const Trajectory& trajectory) {
  std::vector<Timestamp> stamps;
  for (const TrajectoryPose& pose : trajectory.poses()) stamps.push_back(pose.stamp);
  return stamps;
}

std::vector<Timestamp> stamps_of(const std::vector<Relation>& relations) {
  std::vector<Timestamp> stamps;
  for (const Relation& relation : relations) {
    stamps.push_back(relation.t1);
    stamps.push_back(relation.t2);
  }
  return stamps;
}

void move_scans(std::vector<SensorEvent>& events, double seconds) {
  for (SensorEvent& event : events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) {
      scan->stamp = add_seconds(scan->stamp, seconds);
    }
  }
  const auto key = [](const SensorEvent& event) {
    return std::pair(stamp_of(event), std::holds_alternative<LaserScan>(event));
  };
  std::stable_sort(events.begin(), events.end(),
                   [key](const SensorEvent& a, const SensorEvent& b) { return key(a) < key(b); });
}

std::string own_clock_note(const char* what) {
  return fmt::format("{} other stamps than the scans' and stay as they are, taken for the wheels'",
                     what);
}

}  // namespace

double move_onto_wheel_clock(SensorLog& log, std::vector<Relation>* relations) {
  const double offset_s = log.robot.lidar.time_offset_s;
  if (offset_s == 0 || !std::isfinite(offset_s)) return 0;
  std::vector<Timestamp> scans = scan_stamps(log);
  std::sort(scans.begin(), scans.end());
  auto& notes = log.provenance.notes;
  notes.push_back(fmt::format(
      "scans moved by {} s onto the wheels' clock, as lidar.time_offset_s says", -offset_s));
  if (log.truth) {
    if (are_of_scans(stamps_of(*log.truth), scans)) {
      log.truth = moved(*log.truth, -offset_s);
    } else {
      notes.push_back(own_clock_note("true poses have"));
    }
  }
  if (relations != nullptr) {
    if (are_of_scans(stamps_of(*relations), scans)) {
      for (Relation& relation : *relations) {
        relation.t1 = add_seconds(relation.t1, -offset_s);
        relation.t2 = add_seconds(relation.t2, -offset_s);
      }
    } else {
      notes.push_back(own_clock_note("relations have"));
    }
  }
  move_scans(log.events, -offset_s);
  log.robot.lidar.time_offset_s = 0;
  return offset_s;
}

}  // namespace corridor::formats
