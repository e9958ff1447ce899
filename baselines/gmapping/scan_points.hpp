// End points of a scan's usable beams in the base frame, in the layout the score reads.
// It does not correct for motion during the sweep: the original does not either.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/core/scan.hpp"

namespace corridor::gmapping {

// Separate arrays, so that a pose transforms eight points at a time.
struct ScanPoints {
  std::vector<float> x_base_m;
  std::vector<float> y_base_m;
  // Unit vector of each beam, from the sensor to its end point.
  std::vector<float> beam_x_base = {};
  std::vector<float> beam_y_base = {};

  [[nodiscard]] std::size_t size() const { return x_base_m.size(); }
};

struct BeamSelection {
  double max_range_m = 0;  // longer ranges are left out
  double tilt_steps = 0;   // turns all beams by this many angular steps, counter-clockwise
  int stride = 1;          // every stride-th beam from the first; >= 1
};

// End points of the selected beams that are valid and longer than 0.
ScanPoints usable_points(const LaserScan& scan, const BeamSelection& selection);

}  // namespace corridor::gmapping
