// The tree of the particles' paths: every used scan adds one node per particle, and particles that
// stem from the same ancestor share its nodes [Grisetti2007] section VI.
// Nodes of extinct branches are kept; they cost 40 bytes each.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "slam/core/pose2.hpp"

namespace corridor::gmapping {

class Ancestry {
 public:
  static constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();

  // Returns the index of the new node.
  std::size_t add(const Pose2& T_map_base, std::size_t parent) {
    nodes_.push_back({T_map_base, parent});
    return nodes_.size() - 1;
  }

  // Poses from the root to `node`, one per used scan.
  [[nodiscard]] std::vector<Pose2> path_to(std::size_t node) const {
    std::vector<Pose2> path;
    for (; node != kNoParent; node = nodes_[node].parent) path.push_back(nodes_[node].T_map_base);
    return {path.rbegin(), path.rend()};
  }

 private:
  struct Node {
    Pose2 T_map_base;
    std::size_t parent;
  };

  std::vector<Node> nodes_;
};

}  // namespace corridor::gmapping
