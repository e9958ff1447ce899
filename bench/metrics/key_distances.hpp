// The corridor's key distances a, b, c and its angle alpha, measured on the map a system produced:
// walls are fitted as lines to the cells that hold them, as a surveyor would measure a drawing. It
// does not compare trajectories, and it says "not measurable" rather than guess.
#pragma once

#include "bench/results/run_result.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

// b  from the left_end line to the line of right_outer's stretch that closes the first arm (its
// first
//    c metres), between their intersections with the lower_outer line;
// a  from the line of lower_outer's stretch that closes the second arm (its last c metres) to the
//    top_end line, between their intersections with the right_outer line;
// c  from lower_inner to lower_outer: orthogonal distance of the two lines, mean over their common
// stretch; alpha  interior angle between the lower_outer and the right_outer line.
//
// Where a wall is looked for, and how its line and its sigma come about: wall_survey.hpp.
// estimate and truth_world have one pose per scan; the map is in the frame of the estimate.
// status: "ok", or why the quantity is not measurable (true_m is given all the same). A world
// without a corridor gives "the world has no corridor" everywhere.
results::KeyDistances measure_key_distances(const GridMap& map, const Trajectory& estimate,
                                            const Trajectory& truth_world,
                                            const simulation::World& world, double lidar_range_m);

}  // namespace corridor::metrics
