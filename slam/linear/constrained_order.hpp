// Order of elimination with little fill in which some variables have to come last: CAMD on the
// graph of blocks [Chen2008].
#pragma once

#include <span>
#include <vector>

#include "slam/linear/supernodes.hpp"

namespace corridor::linear {

// Variables in order; those of a lower group come before those of a higher one. groups: of every
// variable, each from 0 to the number of variables - 1.
void constrained_minimum_degree_order(const BlockPattern& pattern, std::span<int> groups,
                                      std::vector<int>& order);

}  // namespace corridor::linear
