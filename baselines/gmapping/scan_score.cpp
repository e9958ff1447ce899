#include "baselines/gmapping/scan_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::gmapping {
namespace {

// Points are handled in blocks that stay in the first-level cache; a multiple of the vector width.
constexpr std::size_t kBlock = 64;
using Block = Eigen::Array<float, static_cast<int>(kBlock), 1>;

struct FloatPose {
  explicit FloatPose(const Pose2& pose)
      : x_m(static_cast<float>(pose.x_m())),
        y_m(static_cast<float>(pose.y_m())),
        cos_theta(static_cast<float>(std::cos(pose.theta_rad()))),
        sin_theta(static_cast<float>(std::sin(pose.theta_rad()))) {}

  float x_m, y_m, cos_theta, sin_theta;
};

// From a cell to the one before it on the beam, a diagonal of a cell nearer to the sensor.
Eigen::Vector2i front_cells(const ScanPoints& points, std::size_t index, const FloatPose& pose) {
  const float x = points.beam_x_base[index];
  const float y = points.beam_y_base[index];
  constexpr float kDiagonal_cells = std::numbers::sqrt2_v<float>;
  return {
      static_cast<int>(std::lround(-kDiagonal_cells * (pose.cos_theta * x - pose.sin_theta * y))),
      static_cast<int>(std::lround(-kDiagonal_cells * (pose.sin_theta * x + pose.cos_theta * y)))};
}

// Squared distances of points [begin, begin + count) to their nearest means; the rest of the block
// is filled as "nothing found".
void nearest_block_m2(const EndPointMap& map, const ScanPoints& points, std::size_t begin,
                      std::size_t count, const FloatPose& pose, const GmappingParams& params,
                      Block& out_m2) {
  alignas(32) float x_m[kBlock];
  alignas(32) float y_m[kBlock];
  alignas(32) int column[kBlock];
  alignas(32) int row[kBlock];
  const float* x_base_m = points.x_base_m.data() + begin;
  const float* y_base_m = points.y_base_m.data() + begin;
  const float cells_per_m = map.cells_per_m();
  for (std::size_t i = 0; i < count; ++i) {
    x_m[i] = pose.cos_theta * x_base_m[i] - pose.sin_theta * y_base_m[i] + pose.x_m;
    y_m[i] = pose.sin_theta * x_base_m[i] + pose.cos_theta * y_base_m[i] + pose.y_m;
    column[i] = static_cast<int>(std::floor(x_m[i] * cells_per_m));
    row[i] = static_cast<int>(std::floor(y_m[i] * cells_per_m));
  }
  if (count < kBlock) out_m2.setConstant(2 * kNotFoundM2);
  const int kernel_cells = params.kernel_size_cells;
  for (std::size_t i = 0; i < count; ++i) {
    float& nearest_m2 = out_m2[static_cast<Eigen::Index>(i)];
    if (params.require_free_front && kernel_cells == 1) {
      nearest_m2 = map.nearest_of_nine_with_free_front_m2(x_m[i], y_m[i], column[i], row[i],
                                                          front_cells(points, begin + i, pose));
    } else if (params.require_free_front) {
      nearest_m2 = map.nearest_with_free_front_m2(x_m[i], y_m[i], kernel_cells,
                                                  front_cells(points, begin + i, pose));
    } else if (kernel_cells == 1) {
      nearest_m2 = map.nearest_of_nine_m2(x_m[i], y_m[i], column[i], row[i]);
    } else {
      nearest_m2 = map.nearest_m2(x_m[i], y_m[i], kernel_cells);
    }
  }
}

// Adds up term(block of squared distances, number of points in it) over all points.
template <class Term>
double sum_over_blocks(const EndPointMap& map, const ScanPoints& points, const Pose2& T_map_base,
                       const GmappingParams& params, Term&& term) {
  const FloatPose pose(T_map_base);
  double sum = 0;
  Block nearest_m2;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - begin);
    nearest_block_m2(map, points, begin, count, pose, params, nearest_m2);
    sum += term(nearest_m2, count);
  }
  return sum;
}

}  // namespace

double scan_score(const EndPointMap& map, const ScanPoints& points, const Pose2& T_map_base,
                  const GmappingParams& params) {
  const auto factor = static_cast<float>(-1 / params.score_sigma_m2);
  return sum_over_blocks(
      map, points, T_map_base, params, [factor](const Block& nearest_m2, std::size_t) {
        // Eigen's exp never returns 0, hence the selection.
        return static_cast<double>(
            (nearest_m2 < kNotFoundM2).select((factor * nearest_m2).exp(), 0.0F).sum());
      });
}

double scan_log_likelihood(const EndPointMap& map, const ScanPoints& points,
                           const Pose2& T_map_base, const GmappingParams& params) {
  const double sum_m2 = sum_over_blocks(
      map, points, T_map_base, params, [](const Block& nearest_m2, std::size_t count) {
        const auto used = nearest_m2.head(static_cast<Eigen::Index>(count));
        return static_cast<double>(
            (used < kNotFoundM2).select(used, static_cast<float>(kUnmatchedM2)).sum());
      });
  return -sum_m2 / params.likelihood_sigma_m2;
}

}  // namespace corridor::gmapping
