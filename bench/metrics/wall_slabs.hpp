// Cuts a fitted wall into slabs along it and asks of each: where are its hits, and are they one
// wall or two? Slabs are what is counted as independent: neighbouring cells share scans and bend
// together.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "bench/metrics/wall_line_fit.hpp"

namespace corridor::metrics {

struct SlabStatistics {
  std::size_t num_slabs = 0;  // with at least kMinSlabCells cells of the wall
  double residual_variance_m2 =
      0;  // of the slabs' mean distances around their own line, num_slabs - 2 degrees
  double mean_along_m = 0;  // t: middle of the slabs, along the wall frame's x axis
  double sum_along_m2 = 0;  // sum (t_k - t)^2
  double first_along_m = 0, last_along_m = 0;  // outer edges of the outer slabs
  double doubled_ratio = 0;                    // share of slabs whose hits have two ridges
};

inline constexpr std::size_t kMinSlabCells = 3;

// A slab is doubled if the smoothed profile of its hits across the wall (all in the band) has two
// maxima, the lower at least kSecondRidgeRatio of the higher, and between them falls below
// kValleyRatio of the lower.
inline constexpr double kSecondRidgeRatio = 0.3;
inline constexpr double kValleyRatio = 0.6;

// Fewer than three slabs: all variances 0.
SlabStatistics slab_statistics(std::span<const WallCell> cells, const WallLine& line,
                               const CellShape& shape, double band_half_width_m, double slab_m);

}  // namespace corridor::metrics
