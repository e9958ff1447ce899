// Which direction a scan says nothing about, known from the walls that its beams truly hit.
// It looks at no noise and at no matcher: it is the truth that a degeneracy detector is scored
// with.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulation/lidar_model.hpp"
#include "datasets/simulation/truth.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor::simulation {

// A scan is degenerate if its weaker direction holds less than this part of the translational
// information sum(n n^T) of its beams, n being the normal of the wall hit: about 4 of 225 beams.
inline constexpr double kDegenerateShare = 0.02;

// What a degenerate scan leaves free: a direction of the world in [0, pi), or, where it hits no
// wall at all, every one, for which none is named.
struct FreeDirection {
  std::optional<double> direction_rad;
};
// nullopt if the scan is not degenerate. People count for nothing: they do not stay.
std::optional<FreeDirection> free_direction(std::span<const std::optional<BeamHit>> hits);

// Joins consecutive scans that leave the same direction free (within one degree), or every one.
class DegenerateIntervals {
 public:
  void add(Timestamp stamp, const std::optional<FreeDirection>& free);
  [[nodiscard]] const std::vector<DegenerateInterval>& intervals() const { return intervals_; }

 private:
  std::vector<DegenerateInterval> intervals_;
  bool is_open_ = false;
};

}  // namespace corridor::simulation
