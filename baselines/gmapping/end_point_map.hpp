// A particle's map: per cell the mean of the beam end points that fell into it, in 32 x 32 tiles
// that copies of the map share until one of them writes [Grisetti2007] section VI. It keeps no free
// space: the original's particle maps hold end points only (generateMap = false), so hits equal
// visits in every cell and its occupancy threshold of 0.1 never rejects one.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "baselines/gmapping/scan_points.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::gmapping {

inline constexpr int kTileShift = 5;
inline constexpr int kTileCells = 1 << kTileShift;

// Mean of a cell without hits: so far off that every squared distance to it is above kNotFoundM2.
inline constexpr float kNoMeanM = 1e9F;
inline constexpr float kNotFoundM2 = 1e15F;

// Row-major cells. The spare floats let a row of four be read from any of the first 30 columns.
struct Tile {
  static constexpr std::size_t kNumCells = std::size_t{kTileCells} * kTileCells;
  static constexpr std::size_t kSpare = 4;

  Tile() {
    mean_x_m.fill(kNoMeanM);
    mean_y_m.fill(kNoMeanM);
    hits.fill(0);
  }

  std::array<float, kNumCells + kSpare> mean_x_m;
  std::array<float, kNumCells + kSpare> mean_y_m;
  std::array<std::uint32_t, kNumCells> hits;
};

// Cell (column, row) covers [column, column + 1) x [row, row + 1) times the cell size, in the map
// frame; indices may be negative. Copying costs a table of tile pointers.
class EndPointMap {
 public:
  // Requires cell_size_m > 0.
  explicit EndPointMap(double cell_size_m);

  // Adds every point as seen from T_map_base; a touched tile that is shared is copied first.
  void insert(const ScanPoints& points, const Pose2& T_map_base);

  // Squared distance [m^2] to the nearest mean among the cells at most `kernel_cells` away from the
  // point's own; at least kNotFoundM2 if none of them has a hit.
  [[nodiscard]] float nearest_m2(float x_m, float y_m, int kernel_cells) const;
  // The same for kernel_cells = 1 and (column, row) = the point's own cell; the hot path.
  [[nodiscard]] float nearest_of_nine_m2(float x_m, float y_m, int column, int row) const {
    const int in_tile_column = column & (kTileCells - 1);
    const int in_tile_row = row & (kTileCells - 1);
    const bool is_inside = static_cast<unsigned>(in_tile_column - 1) < kTileCells - 2 &&
                           static_cast<unsigned>(in_tile_row - 1) < kTileCells - 2;
    if (!is_inside) return nearest_around_m2(x_m, y_m, column, row, 1);
    const Tile* tile = tile_of(column, row);
    return tile == nullptr ? 2 * kNotFoundM2
                           : nearest_in_tile_m2(*tile, x_m, y_m, in_tile_column, in_tile_row);
  }

  // As nearest_m2, but of those cells only whose neighbour `front_cells` further has no hit.
  [[nodiscard]] float nearest_with_free_front_m2(float x_m, float y_m, int kernel_cells,
                                                 const Eigen::Vector2i& front_cells) const;
  // The same for kernel_cells = 1, (column, row) = the point's own cell and a front at most one
  // cell away along each axis.
  [[nodiscard]] float nearest_of_nine_with_free_front_m2(float x_m, float y_m, int column, int row,
                                                         const Eigen::Vector2i& front_cells) const {
    const int in_tile_column = column & (kTileCells - 1);
    const int in_tile_row = row & (kTileCells - 1);
    const bool is_inside = static_cast<unsigned>(in_tile_column - 2) < kTileCells - 4 &&
                           static_cast<unsigned>(in_tile_row - 2) < kTileCells - 4;
    if (!is_inside) return nearest_with_free_front_m2(x_m, y_m, 1, front_cells);
    const Tile* tile = tile_of(column, row);
    if (tile == nullptr) return 2 * kNotFoundM2;
    const std::ptrdiff_t front = front_cells.x() + std::ptrdiff_t{kTileCells} * front_cells.y();
    return nearest_in_tile_m2(*tile, x_m, y_m, in_tile_column, in_tile_row, front);
  }

  [[nodiscard]] float cells_per_m() const { return cells_per_m_; }
  [[nodiscard]] int cell_index(float coordinate_m) const {
    return static_cast<int>(std::floor(coordinate_m * cells_per_m_));
  }
  [[nodiscard]] std::uint32_t hits(int column, int row) const;
  // Meaningful where hits > 0.
  [[nodiscard]] Eigen::Vector2f mean_m(int column, int row) const;
  // The tile that holds a cell; nullptr where nothing was written. Equal pointers = shared.
  [[nodiscard]] const Tile* tile_of(int column, int row) const {
    const int tile_column = column >> kTileShift;
    const int tile_row = row >> kTileShift;
    if (!columns_.contains(tile_column) || !rows_.contains(tile_row)) return nullptr;
    return tiles_[table_index(tile_column, tile_row)].get();
  }

 private:
  // The tiles the table covers along one axis: [first, first + count).
  struct TileSpan {
    int first = 0;
    int count = 0;

    [[nodiscard]] bool contains(int index) const {
      return static_cast<unsigned>(index) - static_cast<unsigned>(first) <
             static_cast<unsigned>(count);
    }
  };

  [[nodiscard]] static TileSpan extended(TileSpan span, int index);
  [[nodiscard]] static std::size_t cell_in_tile(int column, int row) {
    return static_cast<std::size_t>(row & (kTileCells - 1)) * kTileCells +
           static_cast<std::size_t>(column & (kTileCells - 1));
  }
  // Requires a tile inside the table.
  [[nodiscard]] std::size_t table_index(int tile_column, int tile_row) const {
    return static_cast<std::size_t>(tile_row - rows_.first) *
               static_cast<std::size_t>(columns_.count) +
           static_cast<std::size_t>(tile_column - columns_.first);
  }
  // front: how much further the cell is that must have no hit; 0 = none must.
  [[nodiscard]] static float nearest_in_tile_m2(const Tile& tile, float x_m, float y_m,
                                                int in_tile_column, int in_tile_row,
                                                std::ptrdiff_t front = 0);
  [[nodiscard]] float nearest_around_m2(float x_m, float y_m, int column, int row,
                                        int kernel_cells) const;
  void add_hit(float x_m, float y_m);
  Tile& writable_tile(int column, int row);
  void cover(int tile_column, int tile_row);

  float cells_per_m_ = 0;
  TileSpan columns_;
  TileSpan rows_;
  std::vector<std::shared_ptr<Tile>> tiles_;  // row-major; null where nothing was written
};

inline float EndPointMap::nearest_in_tile_m2(const Tile& tile, float x_m, float y_m,
                                             int in_tile_column, int in_tile_row,
                                             std::ptrdiff_t front) {
  using Row = Eigen::Array4f;
  const std::ptrdiff_t corner = std::ptrdiff_t{in_tile_row - 1} * kTileCells + (in_tile_column - 1);
  // Three rows of four neighbouring cells; the fourth column is masked out.
  Row best = Row::Constant(2 * kNotFoundM2);
  for (std::ptrdiff_t i = 0; i < 3; ++i) {
    const std::ptrdiff_t row = corner + i * kTileCells;
    const Eigen::Map<const Row> mean_x(tile.mean_x_m.data() + row);
    const Eigen::Map<const Row> mean_y(tile.mean_y_m.data() + row);
    Row distance_m2 = (mean_x - x_m).square() + (mean_y - y_m).square();
    if (front != 0) {
      // 0 where the cell in front has no hit, above kNotFoundM2 where it has.
      const Eigen::Map<const Row> front_x(tile.mean_x_m.data() + row + front);
      distance_m2 += (front_x - kNoMeanM).square();
    }
    best = best.min(distance_m2);
  }
  best += Row(0, 0, 0, 2 * kNotFoundM2);
  return best.minCoeff();
}

}  // namespace corridor::gmapping
