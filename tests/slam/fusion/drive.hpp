// A drive through a room whose key scans lie where the test says.
#pragma once

#include <vector>

#include "slam/fusion/key_scan.hpp"
#include "slam/fusion/local_map.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::fusion {

// Key scans in a room, all at their true poses.
struct Drive {
  explicit Drive(const FusionParams& p) : params(p), map(params) {}

  void add(const Pose2& pose, double path_m) {
    const auto key = static_cast<std::uint32_t>(key_scans.size());
    KeyScan scan;
    scan.scan = testing::scan_of(testing::room(), pose, 30, 0.01, rng);
    scan.points_base_m = testing::points_of(scan.scan);
    scan.path_m = path_m;
    values.set_pose(key, pose);
    key_scans.push_back(scan);
    const Submap* started = map.insert(key, values, key_scans.back().points_base_m);
    if (started != nullptr) values.set_pose(started->frame(), pose);
  }

  FusionParams params;
  LocalMap map;
  graph::Values values;
  std::vector<KeyScan> key_scans;
  Rng rng{8};
};

}  // namespace corridor::fusion
