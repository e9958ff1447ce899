// The plan of a sparse Cholesky factorisation by blocks: order of elimination, supernodes and their
// rows [Liu1990, Davis2016], from the pattern alone. A variable is a block of scalar rows.
#pragma once

#include <span>
#include <vector>

namespace corridor::linear {

// Pairs of variables that share a nonzero block: those of higher number that variable j shares one
// with are rows[starts[j]] ... rows[starts[j + 1] - 1], in any order, each once.
struct BlockPattern {
  std::vector<int> starts = {0};
  std::vector<int> rows;

  [[nodiscard]] int num_variables() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> of(int variable) const {
    const auto j = static_cast<std::size_t>(variable);
    return std::span(rows).subspan(static_cast<std::size_t>(starts[j]),
                                   static_cast<std::size_t>(starts[j + 1] - starts[j]));
  }
};

// Variables in an order of elimination with little fill (AMD on the graph of blocks [Amestoy2004]).
std::vector<int> minimum_degree_order(const BlockPattern& pattern);

// Consecutive places in the order of elimination whose columns of L have the same rows, together
// with those rows: one dense front. Children come before their parent.
struct Supernode {
  int first_place = 0;  // its pivots are the variables at first_place ... end_place - 1
  int end_place = 0;
  int parent = -1;        // supernode; -1 at a root
  std::vector<int> rows;  // places of the variables below the pivots, ascending
};

struct EliminationPlan {
  std::vector<int> order;  // variable at every place
  std::vector<int> place;  // of every variable
  std::vector<Supernode> supernodes;
};

// `order` is kept but for a renumbering that puts subtrees together, which changes no fill.
// dimensions: scalar rows of every variable.
EliminationPlan plan_elimination(const BlockPattern& pattern, const std::vector<int>& order,
                                 std::span<const int> dimensions);

}  // namespace corridor::linear
