// Beams with an angle and a moment each, put into the uniform fan that a LaserScan is. No range is
// invented: a place of the fan without a beam is a beam without return; where two beams share a
// place the nearer is kept. What that costs is counted. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/core/scan.hpp"

namespace corridor::formats {

// One turn of the sensor, beams in the order they were taken.
struct Sweep {
  std::vector<double> ranges_m;  // finite; 0 = no return
  std::vector<double> angles_rad;
  std::vector<std::int64_t> times_us;
};

// What all sweeps of a log share. Angles are the sensor's own and grow while it turns.
struct FanShape {
  std::size_t num_beams = 0;  // places in a full turn
  double seam_rad = 0;        // where a turn begins, between its last beam and its first
  bool is_clockwise = false;  // seen from above: the scan's beams are then in reversed order
};

struct FanLosses {
  std::size_t num_beams = 0;
  std::size_t num_shared_returns = 0;  // returns in the place of a nearer one
  std::size_t num_shared = 0;          // beams without return in the place of another beam
  std::size_t num_beyond_seam = 0;     // point across the seam: half a turn or more off in time
  std::size_t num_without_beam = 0;
  std::size_t num_late = 0;     // moved by more than kNoticed_s from the moment they were taken
  std::size_t num_returns = 0;  // of the beams not beyond the seam
  double sum_moved_rad2 = 0;    // of these
  double max_moved_rad = 0;
  static constexpr double kNoticed_s = 0.005;
};

// The step between beams tells the number of places, the medians of first and last angles
// the seam. At least one sweep with two beams, else num_beams is 0.
FanShape fan_shape(const std::vector<Sweep>& sweeps, bool is_clockwise);

// Place k of the turn lies at seam + (k + 1/2) * 2 pi / n + phase; the phase, at most half a place,
// is the mean of this sweep's beams with return, so that regular beams are hardly moved. The
// moments of the places are the least-squares line through those of the beams: stamp is that of
// beam 0, duration_s leads to beam n - 1 and is negative for a sensor that turns clockwise; both
// are whole microseconds. Ranges of 0 or beyond range_max_m are no return.
LaserScan uniform_fan(const Sweep& sweep, const FanShape& shape, double range_max_m,
                      FanLosses& losses);

}  // namespace corridor::formats
