#include "slam/backend/isam2/elimination_order.hpp"

#include <algorithm>
#include <numeric>

#include "slam/linear/constrained_order.hpp"

namespace corridor::backend {
namespace {

constexpr std::size_t size(int value) { return static_cast<std::size_t>(value); }

}  // namespace

void EliminationOrder::plan(std::span<const int> variables, const VariableSets& sets,
                            std::span<const int> last, std::span<const int> dimensions) {
  variables_ = variables;
  const std::size_t n = variables.size();
  local_.resize(dimensions.size());
  local_dimensions_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    local_[size(variables[k])] = static_cast<int>(k);
    local_dimensions_[k] = dimensions[size(variables[k])];
  }
  find_pattern(sets);
  groups_.assign(n, 0);
  for (const int variable : last) groups_[size(local_[size(variable)])] = n > 1 ? 1 : 0;
  linear::constrained_minimum_degree_order(pattern_, groups_, order_);
  plan_ = linear::plan_elimination(pattern_, order_, local_dimensions_);
  clique_of_place_.resize(n);
  for (std::size_t c = 0; c < plan_.supernodes.size(); ++c) {
    const linear::Supernode& node = plan_.supernodes[c];
    std::fill(clique_of_place_.begin() + node.first_place, clique_of_place_.begin() + node.end_place,
              static_cast<int>(c));
  }
  clique_of_set_.resize(sets.size());
  std::size_t member = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    int first_place = static_cast<int>(n);
    for (std::size_t k = 0; k < sets[s].size(); ++k) {
      first_place = std::min(first_place, plan_.place[size(local_members_[member++])]);
    }
    clique_of_set_[s] = clique_of_place_[size(first_place)];
  }
}

void EliminationOrder::find_pattern(const VariableSets& sets) {
  const std::size_t n = variables_.size();
  local_members_.resize(sets.members().size());
  first_set_of_.assign(n + 1, 0);
  for (std::size_t m = 0; m < local_members_.size(); ++m) {
    local_members_[m] = local_[size(sets.members()[m])];
    ++first_set_of_[size(local_members_[m]) + 1];
  }
  std::partial_sum(first_set_of_.begin(), first_set_of_.end(), first_set_of_.begin());
  sets_of_.resize(local_members_.size());
  std::vector<int>& next = seen_by_;
  next.assign(first_set_of_.begin(), first_set_of_.end() - 1);
  std::size_t member = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t k = 0; k < sets[s].size(); ++k) {
      sets_of_[size(next[size(local_members_[member++])]++)] = static_cast<int>(s);
    }
  }
  pattern_.starts.assign(1, 0);
  pattern_.rows.clear();
  seen_by_.assign(n, -1);
  for (int a = 0; a < static_cast<int>(n); ++a) {
    for (int k = first_set_of_[size(a)]; k < first_set_of_[size(a) + 1]; ++k) {
      for (const int variable : sets[size(sets_of_[size(k)])]) {
        const int b = local_[size(variable)];
        if (b <= a || seen_by_[size(b)] == a) continue;
        seen_by_[size(b)] = a;
        pattern_.rows.push_back(b);
      }
    }
    pattern_.starts.push_back(static_cast<int>(pattern_.rows.size()));
  }
}

}  // namespace corridor::backend
