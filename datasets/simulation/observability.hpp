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

// World direction in [0, pi) that the scan leaves free; nullopt if it fixes both. No hit at all
// leaves everything free and names direction 0. People count for nothing: they do not stay.
std::optional<double> degenerate_direction_rad(std::span<const std::optional<BeamHit>> hits);

// Joins consecutive scans that leave the same direction free (within one degree).
class DegenerateIntervals {
 public:
  void add(Timestamp stamp, std::optional<double> direction_rad);
  [[nodiscard]] const std::vector<DegenerateInterval>& intervals() const { return intervals_; }

 private:
  std::vector<DegenerateInterval> intervals_;
  bool is_open_ = false;
};

}  // namespace corridor::simulation
