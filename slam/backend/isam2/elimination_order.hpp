// Orders the part of a Bayes tree that an update eliminates anew and cuts it into cliques.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/backend/isam2/variable_sets.hpp"
#include "slam/linear/block_pattern.hpp"
#include "slam/linear/supernodes.hpp"

namespace corridor::backend {

// The `count` of `variables` that came last, in no order, or all; they are moved to its end.
std::span<const int> last_born(std::span<int> variables, std::span<const std::int64_t> birth_of,
                               int count);

class EliminationOrder {
 public:
  // variables: ascending. sets: variables that become neighbours, all among `variables`: those of a
  // factor and those of an orphan's separator. last: variables that are eliminated last, among
  // `variables`. dimensions: of every variable of the graph.
  void plan(std::span<const int> variables, const VariableSets& sets, std::span<const int> last,
            std::span<const int> dimensions);

  [[nodiscard]] const std::vector<linear::Supernode>& cliques() const { return plan_->supernodes; }
  // Places of a clique's separator, ascending.
  [[nodiscard]] std::span<const int> separator_of(const linear::Supernode& clique) const {
    return plan_->rows_of(clique);
  }
  // Variable that is eliminated at `place`.
  [[nodiscard]] int variable_at(int place) const {
    return variables_[static_cast<std::size_t>(plan_->order[static_cast<std::size_t>(place)])];
  }
  // Number of the clique that takes set k: the one which eliminates the first of its members.
  [[nodiscard]] int clique_of_set(std::size_t k) const { return clique_of_set_[k]; }

 private:
  void find_pattern(const VariableSets& sets);

  std::span<const int> variables_;
  std::vector<int> local_;  // of every variable of the graph its place in `variables`
  linear::BlockPattern pattern_;
  std::vector<int> local_members_;           // of the sets
  std::vector<int> first_set_of_, sets_of_;  // sets of every local variable, in compressed rows
  std::vector<int> seen_by_, groups_, order_, local_dimensions_, clique_of_place_;
  std::vector<int> clique_of_set_;
  linear::EliminationPlanner planner_;
  const linear::EliminationPlan* plan_ = nullptr;  // the last
};

}  // namespace corridor::backend
