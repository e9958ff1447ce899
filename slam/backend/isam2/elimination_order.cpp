#include "slam/backend/isam2/elimination_order.hpp"

#include <algorithm>
#include <numeric>

#include "slam/linear/minimum_degree.hpp"

namespace corridor::backend {

using linear::to_index;

std::span<const int> last_born(std::span<int> variables, std::span<const std::int64_t> birth_of,
                               int count) {
  const std::size_t num_last = std::min(variables.size(), to_index(count));
  const std::span<int> last = variables.last(num_last);
  std::nth_element(variables.begin(), last.begin(), variables.end(),
                   [&](int a, int b) { return birth_of[to_index(a)] < birth_of[to_index(b)]; });
  return last;
}

void EliminationOrder::plan(std::span<const int> variables, const VariableSets& sets,
                            std::span<const int> last, std::span<const int> dimensions) {
  variables_ = variables;
  const std::size_t n = variables.size();
  local_.resize(dimensions.size());
  local_dimensions_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    local_[to_index(variables[k])] = static_cast<int>(k);
    local_dimensions_[k] = dimensions[to_index(variables[k])];
  }
  find_pattern(sets);
  groups_.assign(n, 0);
  for (const int variable : last) groups_[to_index(local_[to_index(variable)])] = n > 1 ? 1 : 0;
  linear::constrained_minimum_degree_order(pattern_, groups_, order_);
  plan_ = &planner_.plan(pattern_, order_, local_dimensions_);
  clique_of_place_.resize(n);
  for (std::size_t c = 0; c < plan_->supernodes.size(); ++c) {
    const linear::Supernode& node = plan_->supernodes[c];
    std::fill(clique_of_place_.begin() + node.first_place,
              clique_of_place_.begin() + node.end_place, static_cast<int>(c));
  }
  clique_of_set_.resize(sets.size());
  std::size_t member = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    int first_place = static_cast<int>(n);
    for (std::size_t k = 0; k < sets[s].size(); ++k) {
      first_place = std::min(first_place, plan_->place[to_index(local_members_[member++])]);
    }
    clique_of_set_[s] = clique_of_place_[to_index(first_place)];
  }
}

void EliminationOrder::find_pattern(const VariableSets& sets) {
  const std::size_t n = variables_.size();
  local_members_.resize(sets.members().size());
  first_set_of_.assign(n + 1, 0);
  for (std::size_t m = 0; m < local_members_.size(); ++m) {
    local_members_[m] = local_[to_index(sets.members()[m])];
    ++first_set_of_[to_index(local_members_[m]) + 1];
  }
  std::partial_sum(first_set_of_.begin(), first_set_of_.end(), first_set_of_.begin());
  sets_of_.resize(local_members_.size());
  std::vector<int>& next = seen_by_;
  next.assign(first_set_of_.begin(), first_set_of_.end() - 1);
  std::size_t member = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t k = 0; k < sets[s].size(); ++k) {
      sets_of_[to_index(next[to_index(local_members_[member++])]++)] = static_cast<int>(s);
    }
  }
  pattern_.starts.assign(1, 0);
  pattern_.rows.clear();
  seen_by_.assign(n, -1);
  for (int a = 0; a < static_cast<int>(n); ++a) {
    for (int k = first_set_of_[to_index(a)]; k < first_set_of_[to_index(a) + 1]; ++k) {
      for (const int variable : sets[to_index(sets_of_[to_index(k)])]) {
        const int b = local_[to_index(variable)];
        if (b <= a || seen_by_[to_index(b)] == a) continue;
        seen_by_[to_index(b)] = a;
        pattern_.rows.push_back(b);
      }
    }
    pattern_.starts.push_back(static_cast<int>(pattern_.rows.size()));
  }
}

}  // namespace corridor::backend
