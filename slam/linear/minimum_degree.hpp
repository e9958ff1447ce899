// Orders of elimination with little fill.
#pragma once

#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

// Approximate minimum degree on the graph of blocks [Amestoy1996], through SuiteSparse AMD: the
// variable at every place of the order. Throws std::bad_alloc.
std::vector<int> minimum_degree_order(const BlockPattern& pattern);

}  // namespace corridor::linear
