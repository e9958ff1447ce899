// Orders of elimination with little fill.
#pragma once

#include <span>
#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

// Approximate minimum degree on the graph of blocks [Amestoy1996], through SuiteSparse AMD: the
// variable at every place of the order. Throws std::bad_alloc.
std::vector<int> minimum_degree_order(const BlockPattern& pattern);

// The same with variables of a lower group before those of a higher one, through SuiteSparse CAMD
// [Chen2008]. groups: of every variable, 0 ... num_variables - 1.
void constrained_minimum_degree_order(const BlockPattern& pattern, std::span<const int> groups,
                                      std::vector<int>& order);

}  // namespace corridor::linear
