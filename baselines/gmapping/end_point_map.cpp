#include "baselines/gmapping/end_point_map.hpp"

#include <algorithm>
#include <atomic>

#include "slam/core/expect.hpp"

namespace corridor::gmapping {
namespace {

// Tiles added beyond the one that did not fit, so that growing is rare: 8 * 32 * 0.05 m = 13 m.
constexpr int kGrowthTiles = 8;

}  // namespace

EndPointMap::EndPointMap(double cell_size_m) : cells_per_m_(static_cast<float>(1 / cell_size_m)) {
  CORRIDOR_EXPECT(cell_size_m > 0);
}

void EndPointMap::insert(const ScanPoints& points, const Pose2& T_map_base) {
  const auto cos_theta = static_cast<float>(std::cos(T_map_base.theta_rad()));
  const auto sin_theta = static_cast<float>(std::sin(T_map_base.theta_rad()));
  const auto x_m = static_cast<float>(T_map_base.x_m());
  const auto y_m = static_cast<float>(T_map_base.y_m());
  for (std::size_t i = 0; i < points.size(); ++i) {
    add_hit(cos_theta * points.x_base_m[i] - sin_theta * points.y_base_m[i] + x_m,
            sin_theta * points.x_base_m[i] + cos_theta * points.y_base_m[i] + y_m);
  }
}

float EndPointMap::nearest_m2(float x_m, float y_m, int kernel_cells) const {
  return nearest_around_m2(x_m, y_m, cell_index(x_m), cell_index(y_m), kernel_cells);
}

float EndPointMap::nearest_with_free_front_m2(float x_m, float y_m, int kernel_cells,
                                              const Eigen::Vector2i& front_cells) const {
  const int column = cell_index(x_m);
  const int row = cell_index(y_m);
  float best_m2 = 2 * kNotFoundM2;
  for (int r = row - kernel_cells; r <= row + kernel_cells; ++r) {
    for (int c = column - kernel_cells; c <= column + kernel_cells; ++c) {
      const float m2 = (mean_m(c, r) - Eigen::Vector2f(x_m, y_m)).squaredNorm();
      if (m2 < best_m2 && hits(c + front_cells.x(), r + front_cells.y()) == 0) best_m2 = m2;
    }
  }
  return best_m2;
}

float EndPointMap::nearest_around_m2(float x_m, float y_m, int column, int row,
                                     int kernel_cells) const {
  float best_m2 = 2 * kNotFoundM2;
  for (int r = row - kernel_cells; r <= row + kernel_cells; ++r) {
    for (int c = column - kernel_cells; c <= column + kernel_cells; ++c) {
      const Eigen::Vector2f offset_m = mean_m(c, r) - Eigen::Vector2f(x_m, y_m);
      best_m2 = std::min(best_m2, offset_m.squaredNorm());
    }
  }
  return best_m2;
}

std::uint32_t EndPointMap::hits(int column, int row) const {
  const Tile* tile = tile_of(column, row);
  return tile == nullptr ? 0 : tile->hits[cell_in_tile(column, row)];
}

Eigen::Vector2f EndPointMap::mean_m(int column, int row) const {
  const Tile* tile = tile_of(column, row);
  if (tile == nullptr) return {kNoMeanM, kNoMeanM};
  const std::size_t cell = cell_in_tile(column, row);
  return {tile->mean_x_m[cell], tile->mean_y_m[cell]};
}

// A running mean instead of the original's float sum: the same number with less rounding.
void EndPointMap::add_hit(float x_m, float y_m) {
  const int column = cell_index(x_m);
  const int row = cell_index(y_m);
  Tile& tile = writable_tile(column, row);
  const std::size_t cell = cell_in_tile(column, row);
  const std::uint32_t count = ++tile.hits[cell];
  if (count == 1) {
    tile.mean_x_m[cell] = x_m;
    tile.mean_y_m[cell] = y_m;
    return;
  }
  const float share = 1.0F / static_cast<float>(count);
  tile.mean_x_m[cell] += (x_m - tile.mean_x_m[cell]) * share;
  tile.mean_y_m[cell] += (y_m - tile.mean_y_m[cell]) * share;
}

Tile& EndPointMap::writable_tile(int column, int row) {
  const int tile_column = column >> kTileShift;
  const int tile_row = row >> kTileShift;
  cover(tile_column, tile_row);
  std::shared_ptr<Tile>& tile = tiles_[table_index(tile_column, tile_row)];
  if (tile == nullptr) {
    tile = std::make_shared<Tile>();
  } else if (tile.use_count() > 1) {
    tile = std::make_shared<Tile>(*tile);
  } else {
    // Another thread may just have copied this tile and let go of it: its reads come before our
    // writes. use_count() alone is a relaxed load.
    std::atomic_thread_fence(std::memory_order_acquire);
  }
  return *tile;
}

EndPointMap::TileSpan EndPointMap::extended(TileSpan span, int index) {
  if (span.contains(index)) return span;
  if (span.count == 0) return {index - kGrowthTiles, 2 * kGrowthTiles + 1};
  const int end = span.first + span.count;
  if (index < span.first) return {index - kGrowthTiles, end - index + kGrowthTiles};
  return {span.first, index + kGrowthTiles + 1 - span.first};
}

void EndPointMap::cover(int tile_column, int tile_row) {
  if (columns_.contains(tile_column) && rows_.contains(tile_row)) return;
  const TileSpan old_columns = columns_;
  const TileSpan old_rows = rows_;
  std::vector<std::shared_ptr<Tile>> old_tiles = std::move(tiles_);
  columns_ = extended(columns_, tile_column);
  rows_ = extended(rows_, tile_row);
  tiles_.assign(static_cast<std::size_t>(columns_.count) * static_cast<std::size_t>(rows_.count),
                nullptr);
  auto old_tile = old_tiles.begin();
  for (int row = old_rows.first; row < old_rows.first + old_rows.count; ++row) {
    for (int column = old_columns.first; column < old_columns.first + old_columns.count; ++column) {
      tiles_[table_index(column, row)] = std::move(*old_tile++);
    }
  }
}

}  // namespace corridor::gmapping
