// The plan of a sparse Cholesky factorisation by blocks: order of elimination, supernodes and their
// rows [Liu1990, Davis2016], from the pattern alone.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

// Consecutive places in the order of elimination whose columns of L have (nearly) the same rows,
// together with those rows: one dense front.
struct Supernode {
  int first_place = 0;  // its pivots are the variables at first_place ... end_place - 1
  int end_place = 0;
  int parent = -1;                 // supernode that its rows are handed on to; -1 at a root
  int first_row = 0, end_row = 0;  // in EliminationPlan::rows
};

struct EliminationPlan {
  std::vector<int> order;             // variable at every place
  std::vector<int> place;             // of every variable
  std::vector<Supernode> supernodes;  // children before their parent
  std::vector<int> rows;              // of all supernodes

  // Places of the variables below the pivots, ascending.
  [[nodiscard]] std::span<const int> rows_of(const Supernode& node) const {
    return std::span(rows).subspan(to_index(node.first_row),
                                   to_index(node.end_row - node.first_row));
  }
};

// Makes one plan after the other in the same memory.
class EliminationPlanner {
 public:
  EliminationPlanner();
  ~EliminationPlanner();
  EliminationPlanner(EliminationPlanner&&) noexcept;
  EliminationPlanner& operator=(EliminationPlanner&&) noexcept;

  // `order` is kept but for a renumbering that puts subtrees together, which changes no fill.
  // dimensions: scalar rows of every variable. The plan stands until the next one.
  const EliminationPlan& plan(const BlockPattern& pattern, std::span<const int> order,
                              std::span<const int> dimensions);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor::linear
