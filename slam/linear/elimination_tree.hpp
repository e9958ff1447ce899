// The elimination tree of a symmetric matrix [Liu1990]: column j of its Cholesky factor changes
// column parent(j) first. Nodes are places in the order of elimination.
#pragma once

#include <span>
#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

constexpr int kNoNode = -1;

// Pairs of a pattern seen from one of their places: of every place those before it, or those
// behind it, in any order. place: of every variable.
BlockPattern places_before(const BlockPattern& pattern, const std::vector<int>& place);
BlockPattern places_behind(const BlockPattern& pattern, const std::vector<int>& place);

// Parent of every place; kNoNode at a root. before: as places_before() makes it.
std::vector<int> tree_parents(const BlockPattern& before);

// Children of every node as lists: the first of each, and the next of the same parent; ascending.
// The roots are the children of one more node at the end.
struct TreeChildren {
  std::vector<int> first, next;

  explicit TreeChildren(const std::vector<int>& parents);
};

// Nodes so that every subtree is together and children come before their parent.
std::vector<int> tree_postorder(const std::vector<int>& parents);

}  // namespace corridor::linear
