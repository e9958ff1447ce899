// A Bayes tree as plain values, for pictures and tests: which variables each clique eliminates,
// which it leaves to its parent, and which cliques two moments have in common. A copy, made when it
// is asked for; it has no numbers of the linear system in it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/graph/key.hpp"

namespace corridor::backend {

class BackEnd;
class BayesTree;

struct TreeSnapshot {
  static constexpr int kNoParent = -1;

  struct Clique {
    std::vector<graph::Key> frontals;   // eliminated here, in order
    std::vector<graph::Key> separator;  // all of them variables of the parent
    int parent = kNoParent;             // its place among `cliques`
    // Of one back-end, equal numbers at two moments: it is the same clique; its factors have been
    // linearised and eliminated no other time in between.
    std::int64_t birth = 0;
    std::int64_t elimination = 0;
  };
  // Parents before children, siblings by the smallest key that they eliminate. A variable that
  // waits for its first elimination is in none.
  std::vector<Clique> cliques;
};

// What became of a clique at another moment, or had been before.
enum class CliqueFate {
  kUntouched,
  kEliminatedAgain,  // the same variables in the same order, with other numbers
  kReplaced,         // there is no such clique at the other moment
};

inline CliqueFate fate_of(const TreeSnapshot::Clique& clique, const TreeSnapshot& other) {
  const auto same = std::find_if(
      other.cliques.begin(), other.cliques.end(),
      [&](const TreeSnapshot::Clique& candidate) { return candidate.birth == clique.birth; });
  if (same == other.cliques.end()) return CliqueFate::kReplaced;
  return same->elimination == clique.elimination ? CliqueFate::kUntouched
                                                 : CliqueFate::kEliminatedAgain;
}

// keys: of every number of a variable its name.
TreeSnapshot snapshot_of(const BayesTree& tree, std::span<const graph::Key> keys);

// Of `isam2`; nothing for other back-ends, those that are built on it too.
std::optional<TreeSnapshot> tree_of(const BackEnd& back_end);

}  // namespace corridor::backend
