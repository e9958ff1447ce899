// Which key scans are linked by an edge, and which of them a walk over edges reaches.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "baselines/karto/key_scan.hpp"

namespace corridor::karto {

class ScanLinks {
 public:
  // Scans are numbered 0, 1, 2, ... in order of adding.
  void add_scan() { neighbours_.emplace_back(); }
  // False, and nothing changes, if the two are linked already: the first edge wins.
  bool link(KeyScanId a, KeyScanId b);
  [[nodiscard]] bool is_linked(KeyScanId a, KeyScanId b) const;

  [[nodiscard]] std::size_t num_scans() const { return neighbours_.size(); }

  // Breadth-first from `start` over edges, through scans for which `is_near` holds only. In
  // visiting order, `start` first.
  [[nodiscard]] std::vector<KeyScanId> reachable(
      KeyScanId start, const std::function<bool(KeyScanId)>& is_near) const;

 private:
  std::vector<std::vector<KeyScanId>> neighbours_;
};

}  // namespace corridor::karto
