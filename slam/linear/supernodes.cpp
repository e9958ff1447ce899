#include "slam/linear/supernodes.hpp"

#include <amd.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::linear {
namespace {

constexpr int kNone = -1;

constexpr std::size_t size(int value) { return static_cast<std::size_t>(value); }

enum class Side { kLower, kHigher };

// Of every place the places on that side of it that share a block with it.
BlockPattern by_place(const BlockPattern& pattern, const std::vector<int>& place, Side side) {
  const int n = pattern.num_variables();
  const auto for_each_pair = [&](const auto& visit) {
    for (int j = 0; j < n; ++j) {
      for (const int i : pattern.of(j)) {
        const auto [low, high] = std::minmax(place[size(j)], place[size(i)]);
        if (side == Side::kLower) {
          visit(high, low);
        } else {
          visit(low, high);
        }
      }
    }
  };
  BlockPattern placed;
  placed.starts.assign(size(n) + 1, 0);
  placed.rows.resize(pattern.rows.size());
  for_each_pair([&](int of, int) { ++placed.starts[size(of) + 1]; });
  std::partial_sum(placed.starts.begin(), placed.starts.end(), placed.starts.begin());
  std::vector<int> next(placed.starts.begin(), placed.starts.end() - 1);
  for_each_pair([&](int of, int other) { placed.rows[size(next[size(of)]++)] = other; });
  return placed;
}

// Parent of every place in the elimination tree [Liu1990]: ancestors are found with path
// compression.
std::vector<int> parents_of(const BlockPattern& lower) {
  const int n = lower.num_variables();
  std::vector<int> parents(size(n), kNone), ancestors(size(n), kNone);
  for (int j = 0; j < n; ++j) {
    for (int k : lower.of(j)) {
      while (k != kNone && k < j) {
        const int next = ancestors[size(k)];
        ancestors[size(k)] = j;
        if (next == kNone) parents[size(k)] = j;
        k = next;
      }
    }
  }
  return parents;
}

// Children of every node as lists: the first of each, and the next of the same parent; ascending.
// The roots are the children of one more node at the end.
struct Children {
  std::vector<int> first, next;

  explicit Children(const std::vector<int>& parents)
      : first(parents.size() + 1, kNone), next(parents.size(), kNone) {
    for (std::size_t j = parents.size(); j-- > 0;) {
      int& head = first[parents[j] == kNone ? parents.size() : size(parents[j])];
      next[j] = head;
      head = static_cast<int>(j);
    }
  }
};

// Places in postorder of the tree.
std::vector<int> postorder_of(const std::vector<int>& parents) {
  Children children(parents);
  std::vector<int> order, open;
  order.reserve(parents.size());
  int node = static_cast<int>(parents.size());
  for (;;) {
    int& child = children.first[size(node)];
    if (child != kNone) {
      open.push_back(node);
      node = std::exchange(child, children.next[size(child)]);
      continue;
    }
    if (open.empty()) return order;
    order.push_back(node);
    node = open.back();
    open.pop_back();
  }
}

// A supernode under construction: its size in scalars, and how many of its entries are zeros that
// joining columns of different rows has brought.
struct Candidate {
  Supernode node;
  int id = 0;
  double num_pivots = 0, num_rows = 0, num_zeros = 0;

  double num_entries() const { return num_pivots * (num_pivots + 1) / 2 + num_pivots * num_rows; }
};

// Few wide fronts are faster than many narrow ones: a child joins its parent while the share of
// zeros stays small; how small depends on the number of columns, as in CHOLMOD [Chen2008].
bool is_worth_joining(const Candidate& joined) {
  const double zero_ratio = joined.num_zeros / joined.num_entries();
  if (joined.num_pivots <= 12) return true;
  if (joined.num_pivots <= 24) return zero_ratio < 0.3;
  if (joined.num_pivots <= 72) return zero_ratio < 0.1;
  return zero_ratio < 0.05;
}

class SupernodeBuilder {
 public:
  SupernodeBuilder(const std::vector<int>& parents, const BlockPattern& higher,
                   const std::vector<int>& dimensions)
      : parents_(parents), higher_(higher), dimensions_(dimensions) {}

  std::vector<Supernode> build() {
    find_fundamental();
    for (Candidate& candidate : fundamental_) {
      while (!kept_.empty() && kept_.back().node.parent == candidate.id &&
             join(kept_.back(), candidate)) {
        joined_[size(kept_.back().id)] = candidate.id;
        kept_.pop_back();
      }
      kept_.push_back(std::move(candidate));
    }
    return numbered();
  }

 private:
  // Maximal runs j, j + 1, ... in which each is the only child of the next and has its rows.
  void find_fundamental() {
    const int n = higher_.num_variables();
    const Children children(parents_);
    seen_by_.assign(size(n), kNone);
    node_of_.assign(size(n), kNone);
    fundamental_.reserve(size(n));
    for (int j = 0; j < n; ++j) {
      const int child = children.first[size(j)];
      const bool is_only_child =
          child == j - 1 && child >= 0 && children.next[size(child)] == kNone;
      if (!is_only_child || !has_rows_of_last(j)) begin_supernode(j, children);
      Candidate& candidate = fundamental_.back();
      candidate.node.end_place = j + 1;
      candidate.num_pivots += dimensions_[size(j)];
      node_of_[size(j)] = candidate.id;
    }
    for (Candidate& candidate : fundamental_) finish(candidate);
    joined_.assign(fundamental_.size(), kNone);
  }

  [[nodiscard]] bool has_rows_of_last(int place) const {
    const int id = fundamental_.back().id;
    return std::ranges::all_of(higher_.of(place),
                               [&](int row) { return seen_by_[size(row)] == id; });
  }

  // Its rows are those of the matrix and those of its children.
  void begin_supernode(int place, const Children& children) {
    Candidate& candidate = fundamental_.emplace_back();
    candidate.id = static_cast<int>(fundamental_.size()) - 1;
    candidate.node.first_place = place;
    const auto take = [&](std::span<const int> rows) {
      for (const int row : rows) {
        if (row <= place || seen_by_[size(row)] == candidate.id) continue;
        seen_by_[size(row)] = candidate.id;
        candidate.node.rows.push_back(row);
      }
    };
    take(higher_.of(place));
    for (int child = children.first[size(place)]; child != kNone;
         child = children.next[size(child)]) {
      take(fundamental_[size(node_of_[size(child)])].node.rows);
    }
  }

  void finish(Candidate& candidate) const {
    Supernode& node = candidate.node;
    std::erase_if(node.rows, [&node](int row) { return row < node.end_place; });
    std::sort(node.rows.begin(), node.rows.end());
    for (const int row : node.rows) candidate.num_rows += dimensions_[size(row)];
    const int parent = parents_[size(node.end_place - 1)];
    node.parent = parent == kNone ? kNone : node_of_[size(parent)];
  }

  // Takes a last child's pivots into its parent, if that is worth its zeros.
  static bool join(const Candidate& child, Candidate& parent) {
    Candidate both;
    both.num_pivots = child.num_pivots + parent.num_pivots;
    both.num_rows = parent.num_rows;
    both.num_zeros = both.num_entries() - child.num_entries() - parent.num_entries() +
                     child.num_zeros + parent.num_zeros;
    if (!is_worth_joining(both)) return false;
    parent.node.first_place = child.node.first_place;
    parent.num_pivots = both.num_pivots;
    parent.num_zeros = both.num_zeros;
    return true;
  }

  std::vector<Supernode> numbered() {
    std::vector<int> number(fundamental_.size(), kNone);
    for (std::size_t k = 0; k < kept_.size(); ++k) number[size(kept_[k].id)] = static_cast<int>(k);
    std::vector<Supernode> supernodes;
    supernodes.reserve(kept_.size());
    for (Candidate& candidate : kept_) {
      int parent = candidate.node.parent;
      while (parent != kNone && joined_[size(parent)] != kNone) parent = joined_[size(parent)];
      candidate.node.parent = parent == kNone ? kNone : number[size(parent)];
      supernodes.push_back(std::move(candidate.node));
    }
    return supernodes;
  }

  const std::vector<int>& parents_;
  const BlockPattern& higher_;
  const std::vector<int>& dimensions_;  // of every place
  std::vector<int> seen_by_;            // of every place the last supernode that has it as a row
  std::vector<int> node_of_;            // of every place its fundamental supernode
  std::vector<Candidate> fundamental_, kept_;
  std::vector<int> joined_;  // of every fundamental supernode the one that took it
};

}  // namespace

std::vector<int> minimum_degree_order(const BlockPattern& pattern) {
  std::vector<int> order(size(pattern.num_variables()));
  const int status = amd_order(pattern.num_variables(), pattern.starts.data(), pattern.rows.data(),
                               order.data(), nullptr, nullptr);
  CORRIDOR_ENSURE(status == AMD_OK || status == AMD_OK_BUT_JUMBLED);
  return order;
}

EliminationPlan plan_elimination(const BlockPattern& pattern, const std::vector<int>& order,
                                 std::span<const int> dimensions) {
  const std::size_t n = order.size();
  CORRIDOR_EXPECT(size(pattern.num_variables()) == n && dimensions.size() == n);
  EliminationPlan plan{order, std::vector<int>(n), {}};
  const auto find_places = [&plan] {
    for (std::size_t k = 0; k < plan.order.size(); ++k) {
      plan.place[size(plan.order[k])] = static_cast<int>(k);
    }
  };
  find_places();
  const std::vector<int> first_parents = parents_of(by_place(pattern, plan.place, Side::kLower));
  const std::vector<int> postorder = postorder_of(first_parents);
  std::vector<int> moved_to(n), parents(n), placed_dimensions(n);
  for (std::size_t k = 0; k < n; ++k) moved_to[size(postorder[k])] = static_cast<int>(k);
  for (std::size_t k = 0; k < n; ++k) {
    const int parent = first_parents[size(postorder[k])];
    parents[k] = parent == kNone ? kNone : moved_to[size(parent)];
    plan.order[k] = order[size(postorder[k])];
    placed_dimensions[k] = dimensions[size(plan.order[k])];
  }
  find_places();
  const BlockPattern higher = by_place(pattern, plan.place, Side::kHigher);
  plan.supernodes = SupernodeBuilder(parents, higher, placed_dimensions).build();
  return plan;
}

}  // namespace corridor::linear
