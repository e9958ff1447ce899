#include "slam/backend/isam2/tree_snapshot.hpp"

#include "slam/backend/isam2/bayes_tree.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

using graph::Key;

std::vector<Key> named(std::span<const int> variables, std::span<const Key> keys) {
  std::vector<Key> names;
  names.reserve(variables.size());
  for (const int variable : variables) names.push_back(keys[to_index(variable)]);
  return names;
}

// A clique that is still to be copied, and where its parent stands.
struct Waiting {
  int number = BayesTree::kNone;
  int parent = TreeSnapshot::kNoParent;
  Key smallest;
};

Waiting waiting(const BayesTree& tree, int number, int parent, std::span<const Key> keys) {
  const std::vector<Key> frontals = named(tree.clique(number).frontals(), keys);
  return {number, parent, *std::min_element(frontals.begin(), frontals.end())};
}

}  // namespace

TreeSnapshot snapshot_of(const BayesTree& tree, std::span<const Key> keys) {
  TreeSnapshot snapshot;
  std::vector<Waiting> stack;
  // Siblings are on top of the stack; the one to be copied first is the last of them.
  const auto sort_last = [&stack](std::size_t count) {
    std::sort(stack.end() - static_cast<std::ptrdiff_t>(count), stack.end(),
              [](const Waiting& a, const Waiting& b) { return b.smallest < a.smallest; });
  };
  for (const int root : tree.roots()) {
    stack.push_back(waiting(tree, root, TreeSnapshot::kNoParent, keys));
  }
  sort_last(stack.size());
  while (!stack.empty()) {
    const Waiting next = stack.back();
    stack.pop_back();
    const BayesTree::Clique& clique = tree.clique(next.number);
    const int place = static_cast<int>(snapshot.cliques.size());
    snapshot.cliques.push_back({named(clique.frontals(), keys), named(clique.separator(), keys),
                                next.parent, clique.birth, clique.elimination});
    const std::size_t num_before = stack.size();
    for (int child = clique.first_child; child != BayesTree::kNone;
         child = tree.clique(child).next_sibling) {
      stack.push_back(waiting(tree, child, place, keys));
    }
    sort_last(stack.size() - num_before);
  }
  return snapshot;
}

}  // namespace corridor::backend
