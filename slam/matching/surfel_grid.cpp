#include "slam/matching/surfel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::matching {
namespace {

constexpr double kMinPoints = 3;

std::int64_t tile_key(int x, int y) {
  return (static_cast<std::int64_t>(y) << 32) | static_cast<std::uint32_t>(x);
}

int floor_div(int value, int divisor) {
  return value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor);
}

// Eigenvector of the smaller eigenvalue of [xx xy; xy yy], and both eigenvalues.
void decompose(double xx, double xy, double yy, Surfel& surfel) {
  const double mean = 0.5 * (xx + yy);
  const double half_difference = 0.5 * (xx - yy);
  const double radius = std::hypot(half_difference, xy);
  const double angle = 0.5 * std::atan2(xy, half_difference);  // of the larger axis
  surfel.tangent_variance_m2 = mean + radius;
  surfel.normal_variance_m2 = std::max(0.0, mean - radius);
  surfel.normal = {-std::sin(angle), std::cos(angle)};
}

}  // namespace

// Moments about the cell's own centre, so that single precision suffices far from the origin.
struct SurfelGrid::Cell {
  enum class Pooled : std::uint8_t { kStale, kNone, kReady };

  float num_points = 0;
  float x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  Pooled pooled = Pooled::kStale;
  Surfel surfel{};
};

struct SurfelGrid::Tile {
  std::array<Cell, static_cast<std::size_t>(kTileSide* kTileSide)> cells;

  Cell& at(int x, int y) { return cells[static_cast<std::size_t>(y * kTileSide + x)]; }
};

SurfelGrid::SurfelGrid(double resolution_m) : resolution_m_(resolution_m) {
  CORRIDOR_EXPECT(resolution_m > 0);
}
SurfelGrid::SurfelGrid(SurfelGrid&&) noexcept = default;
SurfelGrid& SurfelGrid::operator=(SurfelGrid&&) noexcept = default;
SurfelGrid::~SurfelGrid() = default;

SurfelGrid::Tile* SurfelGrid::tile_at(int tile_x, int tile_y) const {
  const auto found = tiles_.find(tile_key(tile_x, tile_y));
  return found == tiles_.end() ? nullptr : found->second.get();
}

const SurfelGrid::Cell* SurfelGrid::cell_at(int x, int y) const {
  const int tile_x = floor_div(x, kTileSide);
  const int tile_y = floor_div(y, kTileSide);
  Tile* tile = tile_at(tile_x, tile_y);
  return tile == nullptr ? nullptr : &tile->at(x - tile_x * kTileSide, y - tile_y * kTileSide);
}

void SurfelGrid::insert(std::span<const Eigen::Vector2d> points_m) {
  for (const Eigen::Vector2d& point : points_m) {
    const int x = static_cast<int>(std::floor(point.x() / resolution_m_));
    const int y = static_cast<int>(std::floor(point.y() / resolution_m_));
    // The eight neighbours pool this cell too: they must exist and forget what they pooled.
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int tile_x = floor_div(x + dx, kTileSide);
        const int tile_y = floor_div(y + dy, kTileSide);
        auto& tile = tiles_[tile_key(tile_x, tile_y)];
        if (!tile) tile = std::make_unique<Tile>();
        Cell& cell = tile->at(x + dx - tile_x * kTileSide, y + dy - tile_y * kTileSide);
        cell.pooled = Cell::Pooled::kStale;
        if (dx != 0 || dy != 0) continue;
        const auto px = static_cast<float>(point.x() - (x + 0.5) * resolution_m_);
        const auto py = static_cast<float>(point.y() - (y + 0.5) * resolution_m_);
        cell.num_points += 1;
        cell.x += px;
        cell.y += py;
        cell.xx += px * px;
        cell.xy += px * py;
        cell.yy += py * py;
      }
    }
  }
}

void SurfelGrid::pool(int x, int y, Cell& cell) const {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell* c = cell_at(x + dx, y + dy);
      if (c == nullptr || c->num_points == 0) continue;
      const double ox = dx * resolution_m_;
      const double oy = dy * resolution_m_;
      const double m = c->num_points;
      n += m;
      sx += c->x + m * ox;
      sy += c->y + m * oy;
      sxx += c->xx + 2 * ox * c->x + m * ox * ox;
      sxy += c->xy + ox * c->y + oy * c->x + m * ox * oy;
      syy += c->yy + 2 * oy * c->y + m * oy * oy;
    }
  }
  if (n < kMinPoints) {
    cell.pooled = Cell::Pooled::kNone;
    return;
  }
  const double mx = sx / n;
  const double my = sy / n;
  cell.surfel.mean_m = {(x + 0.5) * resolution_m_ + mx, (y + 0.5) * resolution_m_ + my};
  cell.surfel.num_points = n;
  // Sample covariance: unbiased for few points.
  const double scale = 1 / (n - 1);
  decompose((sxx - n * mx * mx) * scale, (sxy - n * mx * my) * scale, (syy - n * my * my) * scale,
            cell.surfel);
  cell.pooled = Cell::Pooled::kReady;
}

const Surfel* SurfelGrid::find(const Eigen::Vector2d& point_m) {
  const int x = static_cast<int>(std::floor(point_m.x() / resolution_m_));
  const int y = static_cast<int>(std::floor(point_m.y() / resolution_m_));
  Cell* cell = const_cast<Cell*>(cell_at(x, y));
  if (cell == nullptr) return nullptr;
  if (cell->pooled == Cell::Pooled::kStale) pool(x, y, *cell);
  return cell->pooled == Cell::Pooled::kReady ? &cell->surfel : nullptr;
}

std::vector<Eigen::Vector2d> SurfelGrid::cell_means_m() const {
  std::vector<std::int64_t> keys;
  keys.reserve(tiles_.size());
  for (const auto& [key, tile] : tiles_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  std::vector<Eigen::Vector2d> means;
  for (const std::int64_t key : keys) {
    const int tile_x = static_cast<int>(static_cast<std::uint32_t>(key & 0xffffffff));
    const int tile_y = static_cast<int>(key >> 32);
    Tile& tile = *tiles_.at(key);
    for (int y = 0; y < kTileSide; ++y) {
      for (int x = 0; x < kTileSide; ++x) {
        const Cell& cell = tile.at(x, y);
        if (cell.num_points == 0) continue;
        means.emplace_back(
            (tile_x * kTileSide + x + 0.5) * resolution_m_ + cell.x / cell.num_points,
            (tile_y * kTileSide + y + 0.5) * resolution_m_ + cell.y / cell.num_points);
      }
    }
  }
  return means;
}

}  // namespace corridor::matching
