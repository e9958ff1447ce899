#include "baselines/karto/scan_links.hpp"

#include <algorithm>

namespace corridor::karto {

bool ScanLinks::is_linked(KeyScanId a, KeyScanId b) const {
  const auto& of_a = neighbours_[a];
  return std::find(of_a.begin(), of_a.end(), b) != of_a.end();
}

bool ScanLinks::link(KeyScanId a, KeyScanId b) {
  if (a == b || is_linked(a, b)) return false;
  neighbours_[a].push_back(b);
  neighbours_[b].push_back(a);
  return true;
}

std::vector<KeyScanId> ScanLinks::reachable(KeyScanId start,
                                            const std::function<bool(KeyScanId)>& is_near) const {
  std::vector<KeyScanId> visited{start};
  std::vector<bool> is_seen(num_scans(), false);
  is_seen[start] = true;
  for (std::size_t next = 0; next < visited.size(); ++next) {
    for (const KeyScanId neighbour : neighbours_[visited[next]]) {
      if (is_seen[neighbour]) continue;
      is_seen[neighbour] = true;
      if (is_near(neighbour)) visited.push_back(neighbour);
    }
  }
  return visited;
}

}  // namespace corridor::karto
