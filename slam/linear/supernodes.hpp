// The plan of a sparse Cholesky factorisation by blocks: order of elimination, supernodes and their
// rows [Liu1990, Davis2016], from the pattern alone.
#pragma once

#include <span>
#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

// Consecutive places in the order of elimination whose columns of L have (nearly) the same rows,
// together with those rows: one dense front.
struct Supernode {
  int first_place = 0;  // its pivots are the variables at first_place ... end_place - 1
  int end_place = 0;
  int parent = -1;        // supernode that its rows are handed on to; -1 at a root
  std::vector<int> rows;  // places of the variables below the pivots, ascending
};

struct EliminationPlan {
  std::vector<int> order;             // variable at every place
  std::vector<int> place;             // of every variable
  std::vector<Supernode> supernodes;  // children before their parent
};

// `order` is kept but for a renumbering that puts subtrees together, which changes no fill.
// dimensions: scalar rows of every variable.
EliminationPlan plan_elimination(const BlockPattern& pattern, const std::vector<int>& order,
                                 std::span<const int> dimensions);

}  // namespace corridor::linear
