// The elimination tree of a symmetric matrix [Liu1990]: column j of its Cholesky factor changes
// column parent(j) first. Nodes are places in the order of elimination.
#pragma once

#include <span>
#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

constexpr int kNoNode = -1;

// The pairs of a pattern seen from their earlier place: of every place those behind it, in any
// order. place: of every variable. `behind` keeps its memory.
void find_places_behind(const BlockPattern& pattern, std::span<const int> place,
                        BlockPattern& behind);

// Children of every node as lists: the first of each, and the next of the same parent; ascending.
// The roots are the children of one more node at the end.
struct TreeChildren {
  std::vector<int> first, next;

  void assign(std::span<const int> parents);
};

// Builds one tree after the other in the same memory.
class EliminationTree {
 public:
  // place: of every variable.
  void build(const BlockPattern& pattern, std::span<const int> place);

  // Of every place; kNoNode at a root.
  [[nodiscard]] const std::vector<int>& parents() const { return parents_; }
  // Nodes so that every subtree is together and children come before their parent.
  [[nodiscard]] const std::vector<int>& postorder() const { return postorder_; }

 private:
  void find_parents();
  void find_postorder();

  BlockPattern before_;  // of every place those before it
  std::vector<int> parents_, ancestors_, postorder_, open_;
  TreeChildren children_;
};

}  // namespace corridor::linear
