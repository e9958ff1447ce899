// Karto's treatment of one key scan: match, link, average, and close loops.
// [Konolige2010] sections IV and V, as shipped. It sees key scans only; who chooses them and what
// happens in between is KartoSlam's.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <memory>
#include <vector>

#include "baselines/karto/chains.hpp"
#include "baselines/karto/pose_graph.hpp"
#include "baselines/karto/scan_matcher.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::karto {

// Totals that explain a run.
struct MapperCounters {
  int sequential_matches = 0;
  int near_chain_matches = 0;
  int near_chain_links = 0;
  int coarse_loop_matches = 0;
  int fine_loop_matches = 0;
  int loop_closures = 0;
  int failed_solves = 0;             // the back-end gave no usable estimate; poses were kept
  std::int64_t dropped_factors = 0;  // by a back-end that forgets old poses
};

class Mapper {
 public:
  // range_threshold_m sizes the grids. `clock` must outlive the mapper. Requires num_threads >= 1;
  // results do not depend on it.
  Mapper(const KartoParams& params, double range_threshold_m, PoseGraph pose_graph,
         StageClock& clock, int num_threads, const MatcherFactory& make_matcher);

  // Adds a usable scan standing at its predicted pose; numbers it and corrects its pose, and at a
  // loop closure those of all scans. The first is taken where it stands.
  void add(KeyScan scan);

  [[nodiscard]] const std::vector<KeyScan>& scans() const { return scans_; }
  [[nodiscard]] const MapperCounters& counters() const { return counters_; }
  [[nodiscard]] const PoseGraph& pose_graph() const { return pose_graph_; }
  // Gives the graph's variables the scans' present poses.
  void publish_poses();

 private:
  void add_in_arena(KeyScan scan);
  [[nodiscard]] KeyScan& newest() { return scans_.back(); }
  [[nodiscard]] const KeyScan& newest() const { return scans_.back(); }
  [[nodiscard]] PoseWithCovariance match_with_buffer();
  void add_vertex();
  void link_and_average(const PoseWithCovariance& matched);
  void link_with_near_chains(std::vector<PoseWithCovariance>& estimates);
  [[nodiscard]] std::vector<MatchResult> match_with(const std::vector<Chain>& chains);
  void link(KeyScanId from, const PoseWithCovariance& matched);
  void link_with_closest(const Chain& chain, const PoseWithCovariance& matched);
  void extend_buffer();
  void close_loops();
  [[nodiscard]] bool try_loop(const Chain& chain);
  void correct_poses();

  void move(KeyScan& scan, const Pose2& T_map_sensor);
  // Of the newest scan.
  MatchResult match(const ScanMatcher& matcher, const Pose2& T_map_sensor_predicted,
                    const Chain& local_map, const MatchOptions& options) const;

  KartoParams params_;
  StageClock& clock_;
  tbb::task_arena arena_;
  // One per thread: near chains are matched at the same time.
  tbb::enumerable_thread_specific<ScanMatcher> sequential_matchers_;
  ScanMatcher loop_matcher_;
  PoseGraph pose_graph_;
  ScanLinks links_;
  Chain buffer_;
  std::vector<KeyScan> scans_;
  std::vector<Eigen::Vector2d> references_m_;  // of scans_, by id
  MapperCounters counters_;
};

}  // namespace corridor::karto
