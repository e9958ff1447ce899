// Surveys the walls of a corridor on the map a system produced: where each wall is expected, which
// cells hold it, its line and how far that can be trusted. It does not know the key distances
// (key_distances.hpp) and never looks at the map to decide what is expected.
//
// Where a wall is looked for. A map may have shrunk by metres, so a wall is expected where the
// robot that saw it believed it was: a point q of a true wall, seen in scan i, was put down by a
// consistent system at T_map_base_i * T_world_base_i^-1 * q. The median over the scans that saw q
// (each coordinate) is its believed position; w_q, 1.4826 times the median absolute deviation of
// the believed positions across the wall, says how far those scans disagree. A cell with hits
// belongs to the seen wall point whose believed position is nearest, if it is within the band:
// max(kMinBand_m, 3 w) but at most kMaxBand_m, w being the median of w_q over the wall's points.
// Cells at the wall's two ends, where another wall begins, are left out, and so are points of a
// wall that was cut away for a door.
//
// Which cells count. All with hits, by their number of hits, also where misses outvote them: the
// cells in front of a wall that runs close to a cell border are such, and without them the wall
// would seem to lie in the middle of its cells. In a map without any hit counts: cells with
// occupancy p > 0.5, weight 2 (p - 0.5).
//
// The line: fit_wall_line() (wall_line_fit.hpp).
//
// Its uncertainty. The stretch is cut into slabs of kSlab_m along the wall, m_k being the mean
// distance of slab k's hits, weighted by their membership; a line through the m_k leaves residuals
// with the variance s^2 = sum residual^2 / (S - 2). With S slabs at t_k and their middle t:
//   var(offset at t) = (s^2 + w^2) / S + g^2,   var(angle) = (s^2 + w^2) / sum (t_k - t)^2 + 12 (g
//   / L)^2.
// g is what is left of the cells' size: kHitGridRatio * resolution (maps with hits) or resolution /
// sqrt(12) (without), divided by the number of rows of cells that the wall crosses, max(1, L |sin
// angle to the grid| / resolution), because crossing them averages it out. L is the stretch's
// length.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

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
inline constexpr double kHitGridRatio = 0.03;

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
  // A point of a true wall that was seen.
  struct BelievedPoint {
    Eigen::Vector2d point_world_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d point_map_m = Eigen::Vector2d::Zero();
    std::size_t wall_index = 0;
    double disagreement_m = 0;  // w_q
  };
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

  void believe_walls(const Trajectory& estimate, const Trajectory& truth_world,
                     const simulation::World& world, double lidar_range_m);
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
