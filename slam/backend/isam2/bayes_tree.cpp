#include "slam/backend/isam2/bayes_tree.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

bool holds(std::span<const int> variables, int variable) {
  return std::find(variables.begin(), variables.end(), variable) != variables.end();
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
  first_rows_.push_back(static_cast<int>(kept_.deltas.size()));
  kept_.deltas.resize(kept_.deltas.size() + to_index(dimension), 0.0);
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
  std::fill_n(kept_.deltas.begin() + first_rows_[to_index(variable)], dimension(variable), 0.0);
}

void BayesTree::touch_path(int number) {
  for (; number != kNone && !at(number).is_touched; number = at(number).parent) {
    at(number).is_touched = true;
    touched_.push_back(number);
  }
}

void BayesTree::unsettle_path(int number) {
  for (; number != kNone && !at(number).is_unsettled; number = at(number).parent) {
    at(number).is_unsettled = true;
    ++num_unsettled_;
  }
}

// They are connected: the one that eliminates the variable, and some below it. Where that one is
// taken out, some orphans and what hangs below them.
template <class Visit>
void BayesTree::for_each_holder(int variable, const Visit& visit) {
  holders_.clear();
  if (clique_of(variable) != kNone) {
    holders_.push_back(clique_of(variable));
  } else {
    std::copy_if(orphans_.begin(), orphans_.end(), std::back_inserter(holders_),
                 [&](int orphan) { return holds(at(orphan).separator(), variable); });
  }
  while (!holders_.empty()) {
    const int holder = holders_.back();
    holders_.pop_back();
    visit(holder);
    for (int child = at(holder).first_child; child != kNone; child = at(child).next_sibling) {
      if (holds(at(child).separator(), variable)) holders_.push_back(child);
    }
  }
}

void BayesTree::add_factor(std::size_t factor, std::span<const int> variables) {
  detached_factors_.push_back(factor);
  for (const int variable : variables) touch(variable);
}

void BayesTree::touch(int variable) { touch_path(clique_of(variable)); }

void BayesTree::touch_everywhere(int variable) {
  for_each_holder(variable, [this](int holder) { touch_path(holder); });
}

void BayesTree::unsettle(int variable) {
  for_each_holder(variable, [this](int holder) { unsettle_path(holder); });
}

std::span<const int> BayesTree::unsettled() {
  unsettled_.clear();
  if (num_unsettled_ == 0) return unsettled_;
  // Whatever is touched or unsettled, so are all above.
  open_stack_ = roots_;
  open_stack_.insert(open_stack_.end(), orphans_.begin(), orphans_.end());
  while (!open_stack_.empty()) {
    const int number = open_stack_.back();
    open_stack_.pop_back();
    if (!at(number).is_unsettled && !at(number).is_touched) continue;
    if (!at(number).is_touched) unsettled_.push_back(number);
    for (int child = at(number).first_child; child != kNone; child = at(child).next_sibling) {
      open_stack_.push_back(child);
    }
  }
  std::reverse(unsettled_.begin(), unsettled_.end());
  return unsettled_;
}

void BayesTree::detach() {
  detached_.clear();
  detached_.swap(waiting_);
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
  std::sort(detached_.begin(), detached_.end());
}

void BayesTree::drop(int number) {
  Clique& clique = at(number);
  for (const int variable : clique.frontals()) clique_of_[to_index(variable)] = kNone;
  memory_.give_back(clique.memory,
                    Front::memory_size(clique.front.num_pivots(), clique.front.num_below()));
  detached_factors_.insert(detached_factors_.end(), clique.factors.begin(), clique.factors.end());
  num_nonzeros_ -= clique.front.num_nonzeros();
  clique.variables.clear();
  clique.factors.clear();
  clique.num_frontals = 0;
  clique.first_child = clique.next_sibling = clique.parent = kNone;
  num_unsettled_ -= clique.is_unsettled ? 1 : 0;
  clique.is_touched = clique.is_unsettled = false;
  free_cliques_.push_back(number);
}

void BayesTree::attach(const VariableSets& sets, std::span<const std::size_t> factors,
                       std::span<const int> last) {
  CORRIDOR_EXPECT(sets.size() == factors.size());
  sets_ = sets;
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
  const auto clique_of_set = [this](std::size_t set) {
    return new_cliques_[to_index(order_.clique_of_set(set))];
  };
  for (std::size_t k = 0; k < factors.size(); ++k) {
    at(clique_of_set(k)).factors.push_back(factors[k]);
  }
  for (std::size_t k = 0; k < orphans_.size(); ++k) {
    hang(orphans_[k], clique_of_set(factors.size() + k));
  }
  orphans_.clear();
  detached_factors_.clear();
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
  for (const int place : order_.separator_of(node)) {
    clique.variables.push_back(order_.variable_at(place));
    num_below += dimension(clique.variables.back());
  }
  clique.is_solved = false;
  clique.birth = ++num_births_;
  clique.memory = memory_.take(Front::memory_size(num_pivots, num_below));
  clique.front = Front(clique.memory, num_pivots, num_below);
  num_nonzeros_ += clique.front.num_nonzeros();
  return number;
}

Front& BayesTree::open(int number) {
  open_ = number;
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
  if (num_good == clique.front.num_pivots()) {
    num_unsettled_ -= clique.is_unsettled ? 1 : 0;
    clique.is_unsettled = clique.is_solved = false;
    clique.elimination = ++num_eliminations_;
    return true;
  }
  int row = 0;
  for (const int variable : clique.frontals()) {
    if (row <= num_good) first_bad_variable_ = variable;
    row += dimension(variable);
  }
  if (clique.is_unsettled) {
    touch_path(open_);
  } else {
    // Every new clique; what hangs below them are orphans again.
    for (const int number : new_cliques_) touch_path(number);
  }
  detach();
  new_cliques_.clear();
  postpone();
  return false;
}

double BayesTree::chi2() const {
  double sum = 0;
  for (const int root : roots_) sum += clique(root).front.chi2();
  return sum;
}

}  // namespace corridor::backend
