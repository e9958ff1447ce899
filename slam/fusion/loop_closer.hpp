// Finds places seen before: the present key scan against finished submaps nearby, in a window that
// grows with the path since the last closure. Two closures in a row must agree before either
// counts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/fusion/key_scan.hpp"
#include "slam/fusion/local_map.hpp"
#include "slam/graph/values.hpp"
#include "slam/matching/observability.hpp"

namespace corridor::fusion {

struct LoopClosure {
  std::uint32_t submap_key = 0;  // origin of the submap
  std::uint32_t scan_key = 0;
  matching::ObservableMatch match;  // T_submap_base of the key scan
};

class LoopCloser {
 public:
  explicit LoopCloser(const FusionParams& params) : params_(params) {}

  // Closures to add now: none, or the two that agreed.
  std::vector<LoopClosure> search(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                  const graph::Values& estimate, double range_sigma_m);
  // Path at which the newest closure in the graph was found: the window grows from there.
  void set_last_closure(double path_m) { last_closure_path_m_ = path_m; }
  [[nodiscard]] int num_candidates() const { return num_candidates_; }

 private:
  [[nodiscard]] Submap* nearest_candidate(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                          const graph::Values& estimate) const;
  [[nodiscard]] std::optional<LoopClosure> match(const KeyScan& key_scan, std::uint32_t key,
                                                 Submap& submap, const graph::Values& estimate,
                                                 double range_sigma_m) const;

  const FusionParams& params_;
  double last_search_path_m_ = 0;
  double last_closure_path_m_ = 0;
  std::optional<LoopClosure> pending_;
  int num_candidates_ = 0;
};

}  // namespace corridor::fusion
