// Fits a straight wall to the hit counts of grid cells by maximum likelihood.
// A cell's hits lie somewhere in its square, so taking its centre for them pulls a wall along an
// axis of the grid towards cell centres (up to 13 mm at 5 cm cells). The likelihood of the counts
// themselves does not. It does not know where to look for a wall or how far to trust the line
// (wall_survey.hpp).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace corridor::metrics {

// A grid cell seen in the wall's frame: x along the expected wall, y across it.
struct WallCell {
  Eigen::Vector2d centre_wall_m = Eigen::Vector2d::Zero();
  double hits = 0;  // or any weight > 0
};

struct CellShape {
  double resolution_m = 0.05;
  double wall_angle_rad = 0;  // direction of the wall frame's x axis in the grid's frame
};

struct WallLine {
  double offset_m = 0;          // y of the line at x = 0
  double angle_rad = 0;         // of the line in the wall frame, |angle_rad| < pi / 2
  double scatter_m = 0;         // standard deviation of hits across the wall, cell size taken out
  double background_ratio = 0;  // share of hits that belong to no wall
  double log_likelihood = 0;

  // Orthogonal distance of a point from the line, positive to its left.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point_wall_m) const;
};

// Model: a hit belongs to the wall with probability 1 - e and then lies at a normally distributed
// distance (0, s) from the line, or else lies anywhere in the band of the given half width. With
// N(u) the normal density and the mean taken over the cell's square, a cell at distance r has the
// density
//   f(r) = (1 - e) mean_cell N + e / (2 band_half_width_m),
// and (offset, angle, s, e) maximise sum hits * ln f. Far hits lose their say (weight of the wall
// in f), as in any redescending M-estimator; the maximum is searched from several offsets, since it
// is not unique. nullopt for fewer than two cells or no spread along the wall.
std::optional<WallLine> fit_wall_line(std::span<const WallCell> cells, const CellShape& shape,
                                      double band_half_width_m);

// Probability that the hits of a cell belong to the wall.
double wall_membership(const WallCell& cell, const WallLine& line, const CellShape& shape,
                       double band_half_width_m);

}  // namespace corridor::metrics
