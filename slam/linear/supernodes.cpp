#include "slam/linear/supernodes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "slam/core/expect.hpp"
#include "slam/linear/elimination_tree.hpp"

namespace corridor::linear {
namespace {

void invert(std::span<const int> permutation, std::vector<int>& inverse) {
  inverse.resize(permutation.size());
  for (std::size_t k = 0; k < permutation.size(); ++k) {
    inverse[to_index(permutation[k])] = static_cast<int>(k);
  }
}

// A supernode under construction: its size in scalars, and how many of its entries are zeros that
// joining columns of different rows has brought.
struct Candidate {
  Supernode node;  // until the end its parent is a candidate's number, its rows are the builder's
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

// Supernodes of one plan after the other.
class SupernodeBuilder {
 public:
  // Of every place: its parent, those behind it, the scalar rows of its variable.
  void build(std::span<const int> parents, const BlockPattern& behind,
             std::span<const int> dimensions, EliminationPlan& plan) {
    parents_ = parents;
    behind_ = &behind;
    dimensions_ = dimensions;
    find_fundamental();
    kept_.clear();
    for (Candidate& candidate : fundamental_) {
      while (!kept_.empty() && kept_.back().node.parent == candidate.id &&
             join(kept_.back(), candidate)) {
        joined_[to_index(kept_.back().id)] = candidate.id;
        kept_.pop_back();
      }
      kept_.push_back(candidate);
    }
    hand_out(plan);
  }

 private:
  // Maximal runs j, j + 1, ... in which each is the only child of the next and has its rows.
  void find_fundamental() {
    const int n = behind_->num_variables();
    children_.assign(parents_);
    seen_by_.assign(to_index(n), kNoNode);
    node_of_.assign(to_index(n), kNoNode);
    fundamental_.clear();
    rows_.clear();
    for (int j = 0; j < n; ++j) {
      const int child = children_.first[to_index(j)];
      const bool is_only_child =
          child == j - 1 && child >= 0 && children_.next[to_index(child)] == kNoNode;
      if (!is_only_child || !has_rows_of_last(j)) begin_supernode(j);
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
    return std::ranges::all_of(behind_->of(place),
                               [&](int row) { return seen_by_[to_index(row)] == id; });
  }

  // Its rows are those of the matrix and those of its children.
  void begin_supernode(int place) {
    Candidate& candidate = fundamental_.emplace_back();
    candidate.id = static_cast<int>(fundamental_.size()) - 1;
    candidate.node.first_place = place;
    candidate.node.first_row = static_cast<int>(rows_.size());
    const auto take = [&](int row) {
      if (row <= place || seen_by_[to_index(row)] == candidate.id) return;
      seen_by_[to_index(row)] = candidate.id;
      rows_.push_back(row);
    };
    for (const int row : behind_->of(place)) take(row);
    for (int child = children_.first[to_index(place)]; child != kNoNode;
         child = children_.next[to_index(child)]) {
      const Supernode& node = fundamental_[to_index(node_of_[to_index(child)])].node;
      for (int k = node.first_row; k < node.end_row; ++k) take(rows_[to_index(k)]);
    }
    candidate.node.end_row = static_cast<int>(rows_.size());
  }

  void finish(Candidate& candidate) {
    Supernode& node = candidate.node;
    const auto begin = rows_.begin() + node.first_row;
    const auto end = std::remove_if(begin, rows_.begin() + node.end_row,
                                    [&node](int row) { return row < node.end_place; });
    node.end_row = static_cast<int>(end - rows_.begin());
    std::sort(begin, end);
    for (auto row = begin; row != end; ++row) candidate.num_rows += dimensions_[to_index(*row)];
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
  void hand_out(EliminationPlan& plan) {
    number_.assign(fundamental_.size(), kNoNode);
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      number_[to_index(kept_[k].id)] = static_cast<int>(k);
    }
    // From the roots down: whatever was joined has the number of the one that took it.
    for (std::size_t id = number_.size(); id-- > 0;) {
      if (joined_[id] != kNoNode) number_[id] = number_[to_index(joined_[id])];
    }
    plan.supernodes.clear();
    plan.rows.clear();
    for (const Candidate& candidate : kept_) {
      Supernode node = candidate.node;
      if (node.parent != kNoNode) node.parent = number_[to_index(node.parent)];
      plan.rows.insert(plan.rows.end(), rows_.begin() + node.first_row,
                       rows_.begin() + node.end_row);
      node.end_row = static_cast<int>(plan.rows.size());
      node.first_row = node.end_row - (candidate.node.end_row - candidate.node.first_row);
      plan.supernodes.push_back(node);
    }
  }

  std::span<const int> parents_, dimensions_;
  const BlockPattern* behind_ = nullptr;
  TreeChildren children_;
  std::vector<int> seen_by_;  // of every place the last supernode that has it as a row
  std::vector<int> node_of_;  // of every place its fundamental supernode
  std::vector<int> rows_;     // of the fundamental supernodes
  std::vector<Candidate> fundamental_, kept_;
  std::vector<int> joined_;  // of every fundamental supernode the one that took it
  std::vector<int> number_;  // of every fundamental supernode, in the plan
};

}  // namespace

struct EliminationPlanner::Impl {
  EliminationPlan plan;
  EliminationTree tree;
  BlockPattern behind;
  SupernodeBuilder builder;
  std::vector<int> place, moved_to, parents, dimensions;  // of places
};

EliminationPlanner::EliminationPlanner() : impl_(std::make_unique<Impl>()) {}
EliminationPlanner::~EliminationPlanner() = default;
EliminationPlanner::EliminationPlanner(EliminationPlanner&&) noexcept = default;
EliminationPlanner& EliminationPlanner::operator=(EliminationPlanner&&) noexcept = default;

const EliminationPlan& EliminationPlanner::plan(const BlockPattern& pattern,
                                                std::span<const int> order,
                                                std::span<const int> dimensions) {
  const std::size_t n = order.size();
  CORRIDOR_EXPECT(to_index(pattern.num_variables()) == n && dimensions.size() == n);
  auto& [plan, tree, behind, builder, place, moved_to, placed_parents, placed_dimensions] = *impl_;
  invert(order, place);
  tree.build(pattern, place);
  invert(tree.postorder(), moved_to);
  plan.order.clear();
  placed_parents.clear();
  placed_dimensions.clear();
  for (const int old_place : tree.postorder()) {
    const int parent = tree.parents()[to_index(old_place)];
    placed_parents.push_back(parent == kNoNode ? kNoNode : moved_to[to_index(parent)]);
    plan.order.push_back(order[to_index(old_place)]);
    placed_dimensions.push_back(dimensions[to_index(plan.order.back())]);
  }
  invert(plan.order, plan.place);
  find_places_behind(pattern, plan.place, behind);
  builder.build(placed_parents, behind, placed_dimensions, plan);
  return plan;
}

}  // namespace corridor::linear
