// Where every scan was, key or not: kept relative to the key scan before it, so that the whole path
// follows when the graph moves the key scans.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/trajectory.hpp"
#include "slam/fusion/key_scan.hpp"
#include "slam/graph/values.hpp"

namespace corridor::fusion {

class ScanPath {
 public:
  // A scan at T_key_base relative to key scan `key`, the last one so far.
  void add(Timestamp stamp, std::uint32_t key, const Pose2& T_key_base) {
    records_.push_back({stamp, key, T_key_base});
  }
  // The next key scan, as tracked from the one before it and before anything was solved.
  void add_arrival(const Pose2& T_key_next) { arrivals_.push_back(T_key_next); }

  // One pose per scan at the estimate of the key scans. Scans between two key scans share the
  // correction of both, in proportion to time.
  [[nodiscard]] Trajectory smoothed(std::span<const KeyScan> key_scans,
                                    const graph::Values& estimate) const;

 private:
  struct Record {
    Timestamp stamp;
    std::uint32_t key;
    Pose2 T_key_base;
  };

  std::vector<Record> records_;
  std::vector<Pose2> arrivals_;  // [i]: T_i_j of key scans i and j = i + 1
};

}  // namespace corridor::fusion
