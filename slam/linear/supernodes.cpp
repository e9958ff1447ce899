#include "slam/linear/supernodes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "slam/core/expect.hpp"
#include "slam/linear/elimination_tree.hpp"

namespace corridor::linear {
namespace {

std::vector<int> inverse_of(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (std::size_t k = 0; k < permutation.size(); ++k) {
    inverse[to_index(permutation[k])] = static_cast<int>(k);
  }
  return inverse;
}

// A supernode under construction: its size in scalars, and how many of its entries are zeros that
// joining columns of different rows has brought.
struct Candidate {
  Supernode node;  // its parent is a candidate's number until the end
  int id = 0;
  double num_pivots = 0, num_rows = 0, num_zeros = 0;

  double num_entries() const { return num_pivots * (num_pivots + 1) / 2 + num_pivots * num_rows; }
};

// Few wide fronts are faster than many narrow ones: a child joins its parent while the share of
// zeros stays below a limit that depends on the number of pivots, as in CHOLMOD [Chen2008]. The
// benchmark linear/block/factorize is fastest near these limits, and flat around them.
struct JoinLimit {
  double max_pivots, zero_ratio;
};
constexpr JoinLimit kJoinLimits[] = {
    {9, 1}, {24, 0.3}, {72, 0.1}, {std::numeric_limits<double>::infinity(), 0.05}};

bool is_worth_joining(const Candidate& joined) {
  const JoinLimit* limit = kJoinLimits;
  while (joined.num_pivots > limit->max_pivots) ++limit;
  return joined.num_zeros < limit->zero_ratio * joined.num_entries();
}

class SupernodeBuilder {
 public:
  SupernodeBuilder(const std::vector<int>& parents, const BlockPattern& behind,
                   const std::vector<int>& dimensions)
      : parents_(parents), behind_(behind), dimensions_(dimensions) {}

  std::vector<Supernode> build() {
    find_fundamental();
    for (Candidate& candidate : fundamental_) {
      while (!kept_.empty() && kept_.back().node.parent == candidate.id &&
             join(kept_.back(), candidate)) {
        joined_[to_index(kept_.back().id)] = candidate.id;
        kept_.pop_back();
      }
      kept_.push_back(std::move(candidate));
    }
    return numbered();
  }

 private:
  // Maximal runs j, j + 1, ... in which each is the only child of the next and has its rows.
  void find_fundamental() {
    const int n = behind_.num_variables();
    const TreeChildren children(parents_);
    seen_by_.assign(to_index(n), kNoNode);
    node_of_.assign(to_index(n), kNoNode);
    fundamental_.reserve(to_index(n));
    for (int j = 0; j < n; ++j) {
      const int child = children.first[to_index(j)];
      const bool is_only_child =
          child == j - 1 && child >= 0 && children.next[to_index(child)] == kNoNode;
      if (!is_only_child || !has_rows_of_last(j)) begin_supernode(j, children);
      Candidate& candidate = fundamental_.back();
      candidate.node.end_place = j + 1;
      candidate.num_pivots += dimensions_[to_index(j)];
      node_of_[to_index(j)] = candidate.id;
    }
    for (Candidate& candidate : fundamental_) finish(candidate);
    joined_.assign(fundamental_.size(), kNoNode);
  }

  [[nodiscard]] bool has_rows_of_last(int place) const {
    const int id = fundamental_.back().id;
    return std::ranges::all_of(behind_.of(place),
                               [&](int row) { return seen_by_[to_index(row)] == id; });
  }

  // Its rows are those of the matrix and those of its children.
  void begin_supernode(int place, const TreeChildren& children) {
    Candidate& candidate = fundamental_.emplace_back();
    candidate.id = static_cast<int>(fundamental_.size()) - 1;
    candidate.node.first_place = place;
    const auto take = [&](std::span<const int> rows) {
      for (const int row : rows) {
        if (row <= place || seen_by_[to_index(row)] == candidate.id) continue;
        seen_by_[to_index(row)] = candidate.id;
        candidate.node.rows.push_back(row);
      }
    };
    take(behind_.of(place));
    for (int child = children.first[to_index(place)]; child != kNoNode;
         child = children.next[to_index(child)]) {
      take(fundamental_[to_index(node_of_[to_index(child)])].node.rows);
    }
  }

  void finish(Candidate& candidate) const {
    Supernode& node = candidate.node;
    std::erase_if(node.rows, [&node](int row) { return row < node.end_place; });
    std::sort(node.rows.begin(), node.rows.end());
    for (const int row : node.rows) candidate.num_rows += dimensions_[to_index(row)];
    const int parent = parents_[to_index(node.end_place - 1)];
    node.parent = parent == kNoNode ? kNoNode : node_of_[to_index(parent)];
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

  // Parents are numbers of kept supernodes at last.
  std::vector<Supernode> numbered() {
    std::vector<int> number(fundamental_.size(), kNoNode);
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      number[to_index(kept_[k].id)] = static_cast<int>(k);
    }
    // From the roots down: whatever was joined has the number of the one that took it.
    for (std::size_t id = number.size(); id-- > 0;) {
      if (joined_[id] != kNoNode) number[id] = number[to_index(joined_[id])];
    }
    std::vector<Supernode> supernodes;
    supernodes.reserve(kept_.size());
    for (Candidate& candidate : kept_) {
      int& parent = candidate.node.parent;
      if (parent != kNoNode) parent = number[to_index(parent)];
      supernodes.push_back(std::move(candidate.node));
    }
    return supernodes;
  }

  const std::vector<int>& parents_;
  const BlockPattern& behind_;
  const std::vector<int>& dimensions_;  // of every place
  std::vector<int> seen_by_;            // of every place the last supernode that has it as a row
  std::vector<int> node_of_;            // of every place its fundamental supernode
  std::vector<Candidate> fundamental_, kept_;
  std::vector<int> joined_;  // of every fundamental supernode the one that took it
};

}  // namespace

EliminationPlan plan_elimination(const BlockPattern& pattern, const std::vector<int>& order,
                                 std::span<const int> dimensions) {
  const std::size_t n = order.size();
  CORRIDOR_EXPECT(to_index(pattern.num_variables()) == n && dimensions.size() == n);
  const std::vector<int> parents = tree_parents(places_before(pattern, inverse_of(order)));
  const std::vector<int> postorder = tree_postorder(parents);
  const std::vector<int> moved_to = inverse_of(postorder);
  EliminationPlan plan;
  std::vector<int> placed_parents, placed_dimensions;
  for (const int old_place : postorder) {
    const int parent = parents[to_index(old_place)];
    placed_parents.push_back(parent == kNoNode ? kNoNode : moved_to[to_index(parent)]);
    plan.order.push_back(order[to_index(old_place)]);
    placed_dimensions.push_back(dimensions[to_index(plan.order.back())]);
  }
  plan.place = inverse_of(plan.order);
  const BlockPattern behind = places_behind(pattern, plan.place);
  plan.supernodes = SupernodeBuilder(placed_parents, behind, placed_dimensions).build();
  return plan;
}

}  // namespace corridor::linear
