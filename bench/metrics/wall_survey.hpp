// Surveys the walls of a corridor on the map a system produced: which cells hold each wall, its
// line and how far that can be trusted.
// It does not know the key distances (key_distances.hpp).
//
// Where a wall is looked for: where the robot that saw it believed it was (believed_walls.hpp). A
// cell with hits belongs to the seen wall point whose believed position is nearest, if that is
// within the band: 3 w, but at least kMinBand_m and at most kMaxBand_m, w being the median over the
// stretch's points of how far the scans disagree. Cells at the wall's two ends, where another wall
// begins, are left out, and so are points where a wall was cut away for a door.
//
// Which cells count: all with hits, by their number of hits, also where misses outvote them. The
// cells in front of a wall that runs close to a border of cells are such, and without them the wall
// would seem to lie in the middle of its cells. In a map without any hit counts: cells with
// occupancy p > 0.5, weight 2 (p - 0.5).
//
// The line: fit_wall_line() (wall_line_fit.hpp).
//
// Its uncertainty. The stretch is cut into S slabs of kSlab_m along the wall, at t_k with the mean
// t; s^2 is the residual variance of their mean distances around a line of their own
// (wall_slabs.hpp):
//   var(offset at t) = (s^2 + w^2) / S + g^2
//   var(angle)       = (s^2 + w^2) / sum (t_k - t)^2 + 12 g^2 / L^2
// g is what is left of the cells' size r. Crossing n = max(1, L |sin angle to the grid| / r) rows
// of cells, the wall's length being L, averages it out:
//   g = kHitGridRatio r / n                       in maps with hit counts
//   g = r hypot(1 / (sqrt(12) n), kFaceRatio)     in those without: occupied cells lie towards the
//                                                 far side of a wall, misses clear the near one.
// w is taken as independent from slab to slab: too careful for poses with white noise, whose walls
// come out more exact, about right for slow drift.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "bench/metrics/believed_walls.hpp"
#include "bench/metrics/wall_line_fit.hpp"
#include "bench/metrics/wall_slabs.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

inline constexpr double kMinBand_m = 0.25;
inline constexpr double kMaxBand_m = 0.6;
inline constexpr double kSlab_m = 0.5;
inline constexpr double kHitGridRatio = 0.02;
inline constexpr double kFaceRatio = 0.25;

// A part of a true wall, from begin_m to end_m along it.
struct WallStretch {
  simulation::Segment wall;
  double begin_m = 0;
  double end_m = 0;
};

// The whole wall.
WallStretch whole(const simulation::Segment& wall);

// A wall's line on the map.
struct MeasuredWall {
  Eigen::Vector2d point_map_m =
      Eigen::Vector2d::Zero();  // on the line, in the middle of what was fitted
  double direction_rad = 0;     // in the map; the way the true wall runs from a_m to b_m
  // Of (point across the line [m], direction [rad]); the two are independent there.
  double offset_sigma_m = 0;
  double direction_sigma_rad = 0;
  double begin_m = 0, end_m = 0;  // first and last slab along the line, from point_map_m
  double scatter_m = 0;           // how thick the wall is drawn (standard deviation)
  std::size_t num_cells = 0;
};

class WallSurvey {
 public:
  // The trajectories are associated with the nearest stamp.
  WallSurvey(const GridMap& map, const Trajectory& estimate, const Trajectory& truth_world,
             const simulation::World& world, double lidar_range_m);

  // The line, or why there is none: "the wall was not seen", "too few cells", "the wall is
  // doubled", ...
  [[nodiscard]] tl::expected<MeasuredWall, std::string> measure(const WallStretch& stretch) const;

 private:
  struct SurveyedCell {
    Eigen::Vector2d centre_map_m = Eigen::Vector2d::Zero();
    double hits = 0;
    std::size_t point_index = 0;  // the nearest believed point
  };

  // Where a stretch should be on the map.
  struct ExpectedWall {
    Pose2 T_map_wall;           // x axis along the believed points
    double disagreement_m = 0;  // w
    double band_m = 0;
    std::vector<bool> is_point_on_it;  // per believed point
  };

  void assign_cells(const GridMap& map);
  [[nodiscard]] std::optional<ExpectedWall> expect(const WallStretch& stretch) const;
  [[nodiscard]] std::vector<WallCell> cells_of(const ExpectedWall& expected) const;
  [[nodiscard]] MeasuredWall measured_wall(const ExpectedWall& expected, const WallLine& line,
                                           const SlabStatistics& slabs) const;

  double resolution_m_ = 0;
  bool has_hit_counts_ = false;
  std::string emptiness_;  // why nothing can be measured at all; empty if something can
  std::vector<BelievedPoint> points_;
  std::vector<SurveyedCell> cells_;
};

}  // namespace corridor::metrics
