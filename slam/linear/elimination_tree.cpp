#include "slam/linear/elimination_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace corridor::linear {
namespace {

enum class Side { kBefore, kBehind };

void by_place(const BlockPattern& pattern, std::span<const int> place, Side side,
              BlockPattern& placed) {
  const auto for_each_pair = [&](const auto& visit) {
    for (int j = 0; j < pattern.num_variables(); ++j) {
      for (const int i : pattern.of(j)) {
        const auto [low, high] = std::minmax(place[to_index(j)], place[to_index(i)]);
        if (side == Side::kBefore) {
          visit(high, low);
        } else {
          visit(low, high);
        }
      }
    }
  };
  // Counted one further than it belongs, so that starts[k + 1] is where k begins, and where it ends
  // once its rows are in.
  placed.starts.assign(pattern.starts.size() + 1, 0);
  placed.rows.resize(pattern.rows.size());
  for_each_pair([&](int of, int) { ++placed.starts[to_index(of) + 2]; });
  std::partial_sum(placed.starts.begin(), placed.starts.end(), placed.starts.begin());
  for_each_pair(
      [&](int of, int other) { placed.rows[to_index(placed.starts[to_index(of) + 1]++)] = other; });
  placed.starts.pop_back();
}

}  // namespace

void find_places_behind(const BlockPattern& pattern, std::span<const int> place,
                        BlockPattern& behind) {
  by_place(pattern, place, Side::kBehind, behind);
}

void TreeChildren::assign(std::span<const int> parents) {
  first.assign(parents.size() + 1, kNoNode);
  next.assign(parents.size(), kNoNode);
  for (std::size_t j = parents.size(); j-- > 0;) {
    int& head = first[parents[j] == kNoNode ? parents.size() : to_index(parents[j])];
    next[j] = std::exchange(head, static_cast<int>(j));
  }
}

void EliminationTree::build(const BlockPattern& pattern, std::span<const int> place) {
  by_place(pattern, place, Side::kBefore, before_);
  find_parents();
  find_postorder();
}

void EliminationTree::find_parents() {
  const std::size_t n = to_index(before_.num_variables());
  parents_.assign(n, kNoNode);
  // Shortcuts towards the root of what is known so far, shortened on every walk.
  ancestors_.assign(n, kNoNode);
  for (int j = 0; j < before_.num_variables(); ++j) {
    for (int k : before_.of(j)) {
      while (k != kNoNode && k < j) {
        const int next = std::exchange(ancestors_[to_index(k)], j);
        if (next == kNoNode) parents_[to_index(k)] = j;
        k = next;
      }
    }
  }
}

void EliminationTree::find_postorder() {
  children_.assign(parents_);
  postorder_.clear();
  open_.clear();
  int node = static_cast<int>(parents_.size());
  for (;;) {
    int& child = children_.first[to_index(node)];
    if (child != kNoNode) {
      open_.push_back(node);
      node = std::exchange(child, children_.next[to_index(child)]);
      continue;
    }
    if (open_.empty()) return;
    postorder_.push_back(node);
    node = open_.back();
    open_.pop_back();
  }
}

}  // namespace corridor::linear
