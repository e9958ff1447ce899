#include "slam/backend/isam2/bayes_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

bool holds(std::span<const int> variables, int variable) {
  return std::find(variables.begin(), variables.end(), variable) != variables.end();
}

double flops_of(double num_pivots, double num_below) {
  return num_pivots * (num_pivots * num_pivots / 3 + num_below * (num_pivots + num_below));
}

}  // namespace

int BayesTree::add_variable(int dimension) {
  CORRIDOR_EXPECT(dimension > 0);
  const auto reused = std::find_if(free_variables_.rbegin(), free_variables_.rend(),
                                   [&](int v) { return dimensions_[to_index(v)] == dimension; });
  if (reused != free_variables_.rend()) {
    const int variable = *reused;
    free_variables_.erase(std::next(reused).base());
    clear_delta(variable);
    waiting_.push_back(variable);
    return variable;
  }
  const int variable = static_cast<int>(dimensions_.size());
  dimensions_.push_back(dimension);
  first_rows_.push_back(static_cast<int>(deltas_.size()));
  deltas_.resize(deltas_.size() + to_index(dimension), 0.0);
  clique_of_.push_back(kNone);
  rows_.push_back(kNone);
  changed_in_.push_back(0);
  is_listed_.push_back(false);
  waiting_.push_back(variable);
  return variable;
}

void BayesTree::forget(int variable) {
  CORRIDOR_EXPECT(clique_of(variable) == kNone);
  std::erase(waiting_, variable);
  std::erase(detached_, variable);
  if (is_listed_[to_index(variable)]) std::erase(changed_, variable);
  is_listed_[to_index(variable)] = false;
  free_variables_.push_back(variable);
}

void BayesTree::clear_delta(int variable) {
  std::fill_n(deltas_.begin() + first_rows_[to_index(variable)], dimension(variable), 0.0);
}

void BayesTree::touch_path(int number) {
  for (; number != kNone && !at(number).is_touched; number = at(number).parent) {
    at(number).is_touched = true;
    touched_.push_back(number);
    num_touched_flops_ += at(number).num_flops;
  }
}

void BayesTree::touch(int variable) { touch_path(clique_of(variable)); }

void BayesTree::touch_everywhere(int variable) {
  if (clique_of(variable) == kNone) return;
  touch(variable);
  touch_holders(clique_of(variable), variable);
}

// The cliques that hold a variable are connected: those below the one that eliminates it.
void BayesTree::touch_holders(int number, int variable) {
  for (int child = at(number).first_child; child != kNone; child = at(child).next_sibling) {
    if (!holds(at(child).separator(), variable)) continue;
    touch_path(child);
    touch_holders(child, variable);
  }
}

void BayesTree::detach() {
  detached_ = std::move(waiting_);
  waiting_.clear();
  for (const int number : touched_) {
    for (const int variable : at(number).frontals()) detached_.push_back(variable);
    for (int child = at(number).first_child; child != kNone; child = at(child).next_sibling) {
      if (at(child).is_touched) continue;
      at(child).parent = kNone;
      orphans_.push_back(child);
    }
  }
  std::erase_if(orphans_, [&](int orphan) { return at(orphan).is_touched; });
  for (const int number : touched_) drop(number);
  std::erase_if(roots_, [&](int root) { return at(root).num_frontals == 0; });
  touched_.clear();
  num_touched_flops_ = 0;
  std::sort(detached_.begin(), detached_.end());
}

void BayesTree::drop(int number) {
  Clique& clique = at(number);
  for (const int variable : clique.frontals()) clique_of_[to_index(variable)] = kNone;
  num_flops_ -= clique.num_flops;
  memory_.give_back(clique.memory,
                    Front::memory_size(clique.front.num_pivots(), clique.front.num_below()));
  clique.variables.clear();
  clique.num_frontals = 0;
  clique.first_child = clique.next_sibling = clique.parent = kNone;
  clique.is_touched = false;
  free_cliques_.push_back(number);
}

void BayesTree::attach(const VariableSets& factors, std::span<const int> last) {
  sets_ = factors;
  for (const int orphan : orphans_) sets_.add(at(orphan).separator());
  order_.plan(detached_, sets_, last, dimensions_);
  new_cliques_.clear();
  for (const linear::Supernode& node : order_.cliques()) new_cliques_.push_back(make_clique(node));
  for (std::size_t k = 0; k < new_cliques_.size(); ++k) {
    const int parent = order_.cliques()[k].parent;
    if (parent == kNone) {
      roots_.push_back(new_cliques_[k]);
    } else {
      hang(new_cliques_[k], new_cliques_[to_index(parent)]);
    }
  }
  for (std::size_t k = 0; k < orphans_.size(); ++k) {
    hang(orphans_[k], new_cliques_[to_index(order_.clique_of_set(factors.size() + k))]);
  }
  orphans_.clear();
  // Factor sets of every new clique.
  first_factor_of_.assign(new_cliques_.size() + 1, 0);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    ++first_factor_of_[to_index(order_.clique_of_set(k)) + 1];
  }
  std::partial_sum(first_factor_of_.begin(), first_factor_of_.end(), first_factor_of_.begin());
  factors_of_.resize(factors.size());
  for (std::size_t k = factors.size(); k-- > 0;) {
    factors_of_[to_index(--first_factor_of_[to_index(order_.clique_of_set(k)) + 1])] =
        static_cast<int>(k);
  }
  // Each start moved to the one before it.
  first_factor_of_.erase(first_factor_of_.begin());
  first_factor_of_.push_back(static_cast<int>(factors.size()));
}

void BayesTree::hang(int child, int parent) {
  at(child).parent = parent;
  at(child).next_sibling = std::exchange(at(parent).first_child, child);
}

int BayesTree::make_clique(const linear::Supernode& node) {
  int number = static_cast<int>(cliques_.size());
  if (free_cliques_.empty()) {
    cliques_.emplace_back();
  } else {
    number = free_cliques_.back();
    free_cliques_.pop_back();
  }
  Clique& clique = at(number);
  int num_pivots = 0, num_below = 0;
  for (int place = node.first_place; place < node.end_place; ++place) {
    const int variable = order_.variable_at(place);
    clique.variables.push_back(variable);
    clique_of_[to_index(variable)] = number;
    num_pivots += dimension(variable);
  }
  clique.num_frontals = static_cast<int>(clique.variables.size());
  for (const int place : node.rows) {
    clique.variables.push_back(order_.variable_at(place));
    num_below += dimension(clique.variables.back());
  }
  clique.is_solved = clique.are_children_due = false;
  clique.memory = memory_.take(Front::memory_size(num_pivots, num_below));
  clique.front = Front(clique.memory, num_pivots, num_below);
  clique.num_flops = flops_of(num_pivots, num_below);
  num_flops_ += clique.num_flops;
  return number;
}

std::span<const int> BayesTree::factors_of(int k) const {
  const int first = first_factor_of_[to_index(k)];
  return std::span(factors_of_)
      .subspan(to_index(first), to_index(first_factor_of_[to_index(k) + 1] - first));
}

Front& BayesTree::open(int k) {
  open_ = new_cliques_[to_index(k)];
  Clique& clique = at(open_);
  clique.front.set_zero();
  int row = 0;
  for (const int variable : clique.variables) {
    rows_[to_index(variable)] = row;
    row += dimension(variable);
  }
  for (int child = clique.first_child; child != kNone; child = at(child).next_sibling) {
    find_runs(at(child), clique.front);
    clique.front.add_update(at(child).front, runs_);
  }
  return clique.front;
}

void BayesTree::find_runs(const Clique& child, const Front& front) {
  runs_.clear();
  int from = 0;
  const auto append = [&](int to, int length) {
    if (!runs_.empty() && runs_.back().to + runs_.back().length == to) {
      runs_.back().length += length;
    } else {
      runs_.push_back({from, to, length});
    }
    from += length;
  };
  for (const int variable : child.separator()) append(row_of(variable), dimension(variable));
  append(front.last_row(), 1);
}

bool BayesTree::close() {
  Clique& clique = at(open_);
  const int num_good = clique.front.eliminate();
  if (num_good == clique.front.num_pivots()) return true;
  int row = 0;
  for (const int variable : clique.frontals()) {
    if (row <= num_good) first_bad_variable_ = variable;
    row += dimension(variable);
  }
  drop_new_cliques();
  return false;
}

void BayesTree::drop_new_cliques() {
  const auto is_new = [&](int number) { return holds(new_cliques_, number); };
  for (const int number : new_cliques_) {
    for (int child = at(number).first_child; child != kNone; child = at(child).next_sibling) {
      if (is_new(child)) continue;
      at(child).parent = kNone;
      orphans_.push_back(child);
    }
  }
  for (const int number : new_cliques_) drop(number);
  std::erase_if(roots_, [&](int root) { return at(root).num_frontals == 0; });
  new_cliques_.clear();
  postpone();
}

double BayesTree::chi2() const {
  double sum = 0;
  for (const int root : roots_) sum += clique(root).front.chi2();
  return sum;
}

}  // namespace corridor::backend
