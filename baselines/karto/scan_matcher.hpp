// What the mapper asks of a scan matcher: where a scan is in a local map, how sure that is, and how
// well it fits.
#pragma once

#include <functional>
#include <span>

#include "baselines/karto/correlation_grid.hpp"
#include "baselines/karto/karto_params.hpp"
#include "baselines/karto/key_scan.hpp"

namespace corridor::karto {

struct MatchOptions {
  bool use_penalty = false;    // prefer poses near the prediction
  bool use_refinement = true;  // fine stage after the coarse one
  // The caller takes no match that responds with this or less: a search without refinement need
  // not tell such poses apart, and may report a smaller response.
  double min_response = 0;
  // A wide search may be shared out to the threads of the present task arena. Changes no match that
  // is taken.
  bool use_threads = false;
};

struct MatchResult {
  Pose2 T_map_sensor;
  // 3x3, order (x_m, y_m, theta_rad): position in map axes, heading.
  Eigen::Matrix3d covariance_map = Eigen::Matrix3d::Zero();
  double response = 0;  // 0 to 1: share of beams that end on a surface of the local map
};

// Finds a scan's pose against the end points of `local_map`, within the window around
// `T_map_sensor_predicted`. Only surfaces facing the predicted position count. One that is made has
// memory of its own, which belongs to one thread at a time.
using ScanMatcher = std::function<MatchResult(
    const KeyScan& scan, const Pose2& T_map_sensor_predicted,
    std::span<const KeyScan* const> local_map, const MatchOptions& options)>;
using MatcherFactory = std::function<ScanMatcher(const GridSpec&, const KartoParams&)>;

}  // namespace corridor::karto
