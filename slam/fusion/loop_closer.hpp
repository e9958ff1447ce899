// Finds places seen before. Where the newest closure is recent the pose is known to within a
// match's reach, and each key scan is matched directly against the old submap around it. Where it
// is not, finished submaps nearby are searched in a window that grows with the path since the last
// closure, and what is found waits until enough of it, spread along the path, agrees in pairs: the
// largest such set [Mangelson2018] counts. One accident, or a row of scans in one place that looks
// like another, closes nothing. What odometry refutes stays in wait; a set twice as large and three
// times as long shows that it was odometry that erred, and is firm.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/core/robot_model.hpp"
#include "slam/fusion/key_scan.hpp"
#include "slam/fusion/local_map.hpp"
#include "slam/graph/values.hpp"
#include "slam/matching/observability.hpp"

namespace corridor::fusion {

struct LoopClosure {
  std::uint32_t submap_frame = 0;  // its pose in the graph
  std::uint32_t scan_key = 0;
  matching::ObservableMatch match;  // T_submap_base of the key scan
  double path_m = 0;                // travelled when the key scan was taken
  bool is_firm = false;             // so much agrees with it that odometry cannot prove it false
};

class LoopCloser {
 public:
  LoopCloser(const RobotModel& robot, const FusionParams& params)
      : robot_(robot), params_(params) {}

  // Closures to add now, for the newest key scan and for those before it that it confirms.
  std::vector<LoopClosure> search(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                  const graph::Values& estimate);
  // Path at which the newest closure in the graph was found: the window grows from there.
  void set_last_closure(double path_m) {
    was_refuted_ = path_m <= last_closure_path_m_;
    last_closure_path_m_ = path_m;
  }
  [[nodiscard]] int num_candidates() const { return num_candidates_; }

 private:
  [[nodiscard]] Submap* nearest_candidate(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                          const graph::Values& estimate) const;
  [[nodiscard]] std::optional<LoopClosure> match_here(const KeyScan& key_scan, std::uint32_t key,
                                                      Submap& submap,
                                                      const graph::Values& estimate) const;
  [[nodiscard]] std::optional<LoopClosure> match_in_window(const KeyScan& key_scan,
                                                           std::uint32_t key, Submap& submap,
                                                           const graph::Values& estimate) const;
  [[nodiscard]] std::vector<LoopClosure> agreeing(const graph::Values& estimate) const;

  const RobotModel& robot_;
  const FusionParams& params_;
  double last_search_path_m_ = 0;
  double last_closure_path_m_ = 0;
  std::vector<LoopClosure> pending_;  // found by search, the last loop_memory_m, in order of path
  bool was_refuted_ = false;          // what it gave last did not stay in the graph
  int num_candidates_ = 0;
};

}  // namespace corridor::fusion
