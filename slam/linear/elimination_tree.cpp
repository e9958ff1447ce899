#include "slam/linear/elimination_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace corridor::linear {
namespace {

enum class Side { kBefore, kBehind };

BlockPattern by_place(const BlockPattern& pattern, const std::vector<int>& place, Side side) {
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
  BlockPattern placed;
  placed.starts.assign(pattern.starts.size(), 0);
  placed.rows.resize(pattern.rows.size());
  for_each_pair([&](int of, int) { ++placed.starts[to_index(of) + 1]; });
  std::partial_sum(placed.starts.begin(), placed.starts.end(), placed.starts.begin());
  std::vector<int> next(placed.starts.begin(), placed.starts.end() - 1);
  for_each_pair([&](int of, int other) { placed.rows[to_index(next[to_index(of)]++)] = other; });
  return placed;
}

}  // namespace

BlockPattern places_before(const BlockPattern& pattern, const std::vector<int>& place) {
  return by_place(pattern, place, Side::kBefore);
}

BlockPattern places_behind(const BlockPattern& pattern, const std::vector<int>& place) {
  return by_place(pattern, place, Side::kBehind);
}

std::vector<int> tree_parents(const BlockPattern& before) {
  const std::size_t n = to_index(before.num_variables());
  // Shortcuts towards the root of what is known so far, shortened on every walk.
  std::vector<int> parents(n, kNoNode), ancestors(n, kNoNode);
  for (int j = 0; j < before.num_variables(); ++j) {
    for (int k : before.of(j)) {
      while (k != kNoNode && k < j) {
        const int next = std::exchange(ancestors[to_index(k)], j);
        if (next == kNoNode) parents[to_index(k)] = j;
        k = next;
      }
    }
  }
  return parents;
}

TreeChildren::TreeChildren(const std::vector<int>& parents)
    : first(parents.size() + 1, kNoNode), next(parents.size(), kNoNode) {
  for (std::size_t j = parents.size(); j-- > 0;) {
    int& head = first[parents[j] == kNoNode ? parents.size() : to_index(parents[j])];
    next[j] = std::exchange(head, static_cast<int>(j));
  }
}

std::vector<int> tree_postorder(const std::vector<int>& parents) {
  TreeChildren children(parents);
  std::vector<int> order, open;
  order.reserve(parents.size());
  int node = static_cast<int>(parents.size());
  for (;;) {
    int& child = children.first[to_index(node)];
    if (child != kNoNode) {
      open.push_back(node);
      node = std::exchange(child, children.next[to_index(child)]);
      continue;
    }
    if (open.empty()) return order;
    order.push_back(node);
    node = open.back();
    open.pop_back();
  }
}

}  // namespace corridor::linear
