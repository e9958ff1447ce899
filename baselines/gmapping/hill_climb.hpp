// Hill climbing over poses with step halving: the scan matcher of GMapping, for any score.
// It takes the first local maximum and knows nothing about its spread.
#pragma once

#include <array>

#include "slam/core/pose2.hpp"

namespace corridor::gmapping {

struct HillClimbSteps {
  double linear_m = 0.05;
  double angular_rad = 0.05;
  int num_refinements = 5;
};

struct HillClimbResult {
  Pose2 T_map_base;
  double score = 0;
  int num_evaluations = 0;
};

// Each pass tries six neighbours of the present pose (+-x, +-y in the axes of the map, +-theta) and
// moves to the best if it is better; a pass without a better neighbour halves both steps before the
// next. Ends with the first pass without improvement after `num_refinements` halvings, so the
// smallest steps tried are the first ones / 2^num_refinements.
// `score` is called as double score(const Pose2&).
template <class Score>
HillClimbResult hill_climb(const Pose2& T_map_start, const HillClimbSteps& steps, Score&& score) {
  HillClimbResult best{
      .T_map_base = T_map_start, .score = score(T_map_start), .num_evaluations = 1};
  double linear_m = steps.linear_m;
  double angular_rad = steps.angular_rad;
  for (int num_halvings = 0;;) {
    const Pose2 centre = best.T_map_base;
    const double centre_score = best.score;
    const std::array<Eigen::Vector3d, 6> moves = {{{linear_m, 0, 0},
                                                   {-linear_m, 0, 0},
                                                   {0, -linear_m, 0},
                                                   {0, linear_m, 0},
                                                   {0, 0, angular_rad},
                                                   {0, 0, -angular_rad}}};
    for (const Eigen::Vector3d& move : moves) {
      const Pose2 neighbour(centre.x_m() + move.x(), centre.y_m() + move.y(),
                            centre.theta_rad() + move.z());
      const double neighbour_score = score(neighbour);
      if (neighbour_score > best.score) {
        best.T_map_base = neighbour;
        best.score = neighbour_score;
      }
    }
    best.num_evaluations += static_cast<int>(moves.size());
    if (best.score > centre_score) continue;
    if (num_halvings >= steps.num_refinements) return best;
    ++num_halvings;
    linear_m *= 0.5;
    angular_rad *= 0.5;
  }
}

}  // namespace corridor::gmapping
