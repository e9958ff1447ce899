// When the wheels slip: drawn events, and what the floor's limited grip makes of a drive.
#pragma once

#include <vector>

#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/truth.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

// Uniform over all ways to place the slips one after the other in the drive.
std::vector<SlipInterval> drawn_slips(const SlipParams& params, double drive_s, Rng rng);

// Adds the intervals in which the drive's wheels turned at another speed than the robot moved (by
// more than 1 cm/s), with the mean ratio; what lies in an event already there is cut out. Keeps the
// list in order.
void append_friction_slips(const Drive& drive, std::vector<SlipInterval>& slips);

// Ratio of the event at a moment; 0 without, and 0 in intervals of limited grip, whose wheel speeds
// are in the drive already.
double event_ratio_at(const std::vector<SlipInterval>& slips, double time_s);

}  // namespace corridor::simulation
