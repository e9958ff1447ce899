// Matches the key scans of a finished submap against all of it. While a submap grows its scans are
// matched against what little is there: the second lies where the first one's noise says, and so
// on. The finished submap is the mean of all, and tells each its place better. Scan-to-map
// refinement as in a bundle adjustment with the map held [Cartographer2016, sec. V: nodes against
// submaps].
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/robot_model.hpp"
#include "slam/fusion/key_scan.hpp"
#include "slam/fusion/local_map.hpp"
#include "slam/graph/any_factor.hpp"
#include "slam/graph/values.hpp"

namespace corridor::fusion {

// A place of a key scan in a submap, known better than before.
struct RefinedPlace {
  graph::NewFactor factor;
  std::optional<graph::FactorId> replaced;  // the factor that says the same, less well
};

// The factor that ties a submap's frame to the first of its scans, which lies at the identity:
// where the scan sees, with its noise; where it does not, exactly, for that is what the frame
// means.
graph::NewFactor frame_factor(Submap& submap, const KeyScan& first, const RobotModel& robot,
                              const FusionParams& params);

class SubmapRefiner {
 public:
  SubmapRefiner(const RobotModel& robot, const FusionParams& params)
      : robot_(robot), params_(params) {}

  // Goes on with the finished submaps by at most max_scans scans. Returns the places in those that
  // it is through with now, all at once: each batch has the solver go back as far as the submap.
  std::vector<RefinedPlace> next(int max_scans, std::span<const KeyScan> key_scans,
                                 LocalMap& local_map, const graph::Values& estimate);
  // Those that are left when nothing more comes, of the active submap too: a younger one consists
  // of too few scans to tell one of them more than it says itself.
  std::vector<RefinedPlace> rest(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                 const graph::Values& estimate);
  // Finished submaps that it is through with.
  [[nodiscard]] std::size_t num_done() const { return submap_; }

 private:
  void refine(Submap& submap, std::size_t scan, std::span<const KeyScan> key_scans,
              const graph::Values& estimate, std::vector<RefinedPlace>& places) const;

  const RobotModel& robot_;
  const FusionParams& params_;
  std::size_t submap_ = 0, scan_ = 0;  // the next one
  std::vector<RefinedPlace> waiting_;  // in that submap
};

}  // namespace corridor::fusion
