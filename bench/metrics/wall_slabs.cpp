#include "bench/metrics/wall_slabs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace corridor::metrics {
namespace {

// Smoothing of a profile and the step it is looked at with, in cells: wide enough to hide the rows
// of cells.
constexpr double kBandwidth_cells = 0.45;
constexpr double kProfileStep_cells = 0.25;
constexpr double kMinMembership = 0.5;

struct Slab {
  std::vector<double> distances_m, hits;  // of all cells in the band
  double sum_hits = 0, sum_distance = 0;  // weighted by membership
  std::size_t num_cells_of_wall = 0;
};

std::map<int, Slab> cut_into_slabs(std::span<const WallCell> cells, const WallLine& line,
                                   const CellShape& shape, double band_half_width_m,
                                   double slab_m) {
  std::map<int, Slab> slabs;
  for (const WallCell& cell : cells) {
    Slab& slab = slabs[static_cast<int>(std::floor(cell.centre_wall_m.x() / slab_m))];
    const double distance_m = line.distance_m(cell.centre_wall_m);
    const double membership = wall_membership(cell, line, shape, band_half_width_m);
    slab.distances_m.push_back(distance_m);
    slab.hits.push_back(cell.hits);
    slab.sum_hits += membership * cell.hits;
    slab.sum_distance += membership * cell.hits * distance_m;
    if (membership > kMinMembership) ++slab.num_cells_of_wall;
  }
  std::erase_if(slabs, [](const auto& entry) {
    return entry.second.num_cells_of_wall < kMinSlabCells || !(entry.second.sum_hits > 0);
  });
  return slabs;
}

std::vector<double> smoothed_profile(const Slab& slab, double half_width_m, double resolution_m) {
  const double bandwidth_m = kBandwidth_cells * resolution_m;
  const double step_m = kProfileStep_cells * resolution_m;
  const int num_steps = static_cast<int>(std::ceil(half_width_m / step_m));
  std::vector<double> profile;
  for (int i = -num_steps; i <= num_steps; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < slab.hits.size(); ++k) {
      const double u = (slab.distances_m[k] - i * step_m) / bandwidth_m;
      sum += slab.hits[k] * std::exp(-0.5 * u * u);
    }
    profile.push_back(sum);
  }
  return profile;
}

bool has_two_ridges(const std::vector<double>& profile) {
  const auto highest = std::max_element(profile.begin(), profile.end());
  // Away from the highest maximum to one side: the lowest point so far, and whether the profile
  // rises from it again to a second ridge.
  const auto rises_again = [&](auto begin, auto end) {
    double valley = *highest;
    for (auto it = begin; it != end; ++it) {
      valley = std::min(valley, *it);
      if (*it >= kSecondRidgeRatio * *highest && valley < kValleyRatio * *it) return true;
    }
    return false;
  };
  return rises_again(highest, profile.end()) ||
         rises_again(std::make_reverse_iterator(highest), profile.rend());
}

}  // namespace

SlabStatistics slab_statistics(std::span<const WallCell> cells, const WallLine& line,
                               const CellShape& shape, double band_half_width_m, double slab_m) {
  const auto slabs = cut_into_slabs(cells, line, shape, band_half_width_m, slab_m);
  SlabStatistics result;
  result.num_slabs = slabs.size();
  if (slabs.empty()) return result;
  const auto n = static_cast<double>(slabs.size());
  result.first_along_m = slabs.begin()->first * slab_m;
  result.last_along_m = (slabs.rbegin()->first + 1) * slab_m;
  double mean_distance_m = 0;
  for (const auto& [index, slab] : slabs) {
    result.mean_along_m += (index + 0.5) * slab_m / n;
    mean_distance_m += slab.sum_distance / slab.sum_hits / n;
    const auto profile = smoothed_profile(slab, band_half_width_m, shape.resolution_m);
    if (has_two_ridges(profile)) result.doubled_ratio += 1 / n;
  }
  double sum_product_m2 = 0, sum_distance_m2 = 0;
  for (const auto& [index, slab] : slabs) {
    const double along_m = (index + 0.5) * slab_m - result.mean_along_m;
    const double distance_m = slab.sum_distance / slab.sum_hits - mean_distance_m;
    result.sum_along_m2 += along_m * along_m;
    sum_product_m2 += along_m * distance_m;
    sum_distance_m2 += distance_m * distance_m;
  }
  if (slabs.size() < 3) return result;
  const double residual_m2 =
      sum_distance_m2 - sum_product_m2 * sum_product_m2 / result.sum_along_m2;
  result.residual_variance_m2 = std::max(residual_m2, 0.0) / (n - 2);
  return result;
}

}  // namespace corridor::metrics
