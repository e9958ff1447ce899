#include "datasets/simulation/map_borders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "datasets/simulation/surfaces.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kRounding = 1e-9;
constexpr double kDegree_rad = std::numbers::pi / 180;

template <class IsOccupied>
GridMap map_where(int side_cells, const IsOccupied& is_occupied) {
  GridMap map(1, {0, 0}, side_cells, side_cells);
  for (int row = 0; row < side_cells; ++row) {
    for (int column = 0; column < side_cells; ++column) {
      map.at(column, row) = {
          .log_odds = is_occupied(Vector2d(column + 0.5, row + 0.5)) ? 3.f : -3.f,
          .is_observed = true};
    }
  }
  return map;
}

// Cells at random, alone or as noise on slanted walls, discs and slabs.
GridMap random_map(Rng& rng) {
  const int side_cells = 8 + static_cast<int>(rng.below(50));
  const double density = rng.uniform() < 0.3 ? rng.uniform(0, 0.6) : rng.uniform(0, 0.03);
  const double angle_rad = rng.uniform(0, std::numbers::pi);
  const Vector2d normal(std::cos(angle_rad), std::sin(angle_rad));
  const double offset = rng.uniform(-20, 40);
  const double thickness = rng.uniform(0, 6);
  const Vector2d centre(rng.uniform(0, 50), rng.uniform(0, 50));
  const double radius = rng.uniform(0, 20);
  return map_where(side_cells, [&](const Vector2d& point) {
    const bool is_wall = std::abs(normal.dot(point) - offset) < thickness;
    const bool is_disc = (point - centre).norm() < radius;
    return (is_wall != is_disc) != (rng.uniform() < density);
  });
}

std::vector<Segment> segments_of(const std::vector<Ring>& rings) {
  std::vector<Segment> segments;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2i& next = ring[(i + 1) % ring.size()];
      if (ring[i] != next) segments.push_back({ring[i].cast<double>(), next.cast<double>()});
    }
  }
  return segments;
}

std::vector<Ring> all_straightened(std::vector<Ring> rings) {
  for (Ring& ring : rings) ring = straightened(ring);
  return rings;
}

double distance_to(const std::vector<Segment>& segments, const Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments) least = std::min(least, clearance_m(segment, point));
  return least;
}

// Of the points along `from`, every fifth of a cell.
double farthest(const std::vector<Segment>& from, const std::vector<Segment>& to) {
  double most = 0;
  for (const Segment& segment : from) {
    const int num_steps = 1 + static_cast<int>(5 * segment.length_m());
    for (int k = 0; k <= num_steps; ++k) {
      const Vector2d along = segment.b_m - segment.a_m;
      most = std::max(most, distance_to(to, segment.a_m + along * k / num_steps));
    }
  }
  return most;
}

TEST(OccupiedBorders, AreTheEdgesBetweenOccupiedCellsAndOthersEachOnce) {
  Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const GridMap map = random_map(rng);
    const auto is_occupied = [&](int column, int row) {
      return map.contains(column, row) && map.at(column, row).log_odds > 0;
    };
    std::map<std::array<int, 4>, int> num_times;  // an edge's ends, the occupied cell to the left
    for (const Ring& ring : occupied_borders(map)) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vector2i run = ring[(k + 1) % ring.size()] - ring[k];
        const Vector2i step = run.cwiseSign();
        ASSERT_EQ(step.lpNorm<1>(), 1);
        for (Vector2i at = ring[k]; at != ring[k] + run; at += step) {
          ++num_times[{at.x(), at.y(), at.x() + step.x(), at.y() + step.y()}];
        }
      }
    }
    std::size_t num_edges = 0;
    for (int row = 0; row < map.num_rows(); ++row) {
      for (int column = 0; column < map.num_columns(); ++column) {
        if (!is_occupied(column, row)) continue;
        const auto expect_edge = [&](bool is_edge, std::array<int, 4> edge) {
          num_edges += is_edge;
          EXPECT_EQ(num_times.count(edge), is_edge ? 1u : 0u);
        };
        expect_edge(!is_occupied(column, row - 1), {column, row, column + 1, row});
        expect_edge(!is_occupied(column + 1, row), {column + 1, row, column + 1, row + 1});
        expect_edge(!is_occupied(column, row + 1), {column + 1, row + 1, column, row + 1});
        expect_edge(!is_occupied(column - 1, row), {column, row + 1, column, row});
      }
    }
    EXPECT_EQ(num_times.size(), num_edges);
    EXPECT_TRUE(std::all_of(num_times.begin(), num_times.end(),
                            [](const auto& entry) { return entry.second == 1; }));
  }
}

TEST(OccupiedBorders, JoinCellsThatTouchAtACorner) {
  EXPECT_EQ(
      occupied_borders(
          map_where(6, [](const Vector2d& point) { return std::abs(point.x() - point.y()) < 0.1; }))
          .size(),
      1u);
}

TEST(StraightenedBorders, LieWithinTheToleranceOfTheTracedOnesAndTheseOfThem) {
  Rng rng(2);
  for (int i = 0; i < 60; ++i) {
    const std::vector<Ring> rings = occupied_borders(random_map(rng));
    const std::vector<Segment> traced = segments_of(rings);
    const std::vector<Segment> straight = segments_of(all_straightened(rings));
    EXPECT_LE(farthest(traced, straight), kStraightWithin_cells + kRounding) << i;
    EXPECT_LE(farthest(straight, traced), kStraightWithin_cells + kRounding) << i;
  }
}

// With the last test: what is farther from every border than the tolerance is neither cut off nor
// swallowed.
TEST(StraightenedBorders, AreClosedAndKeepPlacesBeyondTheToleranceOnTheirSide) {
  Rng rng(3);
  int num_tried = 0;
  for (int i = 0; i < 60; ++i) {
    const GridMap map = random_map(rng);
    const std::vector<Ring> rings = occupied_borders(map);
    const std::vector<Segment> traced = segments_of(rings);
    const std::vector<Segment> straight = segments_of(all_straightened(rings));
    for (int row = 0; row < map.num_rows(); ++row) {
      for (int column = 0; column < map.num_columns(); ++column) {
        const Vector2d centre(column + 0.5, row + 0.5);
        if (distance_to(traced, centre) <= kStraightWithin_cells) continue;
        ++num_tried;
        // Crossings of a ray that passes no corner of cells.
        int num_crossed = 0;
        for (const Segment& wall : straight) {
          num_crossed += distance_to_m(wall, centre, Vector2d(1, 1e-4).normalized()).has_value();
        }
        EXPECT_EQ(num_crossed % 2 == 1, map.at(column, row).log_odds > 0);
      }
    }
  }
  EXPECT_GT(num_tried, 10000);
}

TEST(StraightenedBorders, OfASlabOfAnyDirectionRunAlongIt) {
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const double angle_rad = rng.uniform(0, std::numbers::pi);
    const Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
    const Vector2d across(-along.y(), along.x());
    const Vector2d middle(rng.uniform(120, 130), rng.uniform(120, 130));
    const std::vector<Ring> rings = occupied_borders(map_where(250, [&](const Vector2d& point) {
      return std::abs(along.dot(point - middle)) < 100 && std::abs(across.dot(point - middle)) < 20;
    }));
    ASSERT_EQ(rings.size(), 1u);
    // Corners may be cut, and a wall whose end is cut may have a kink of a cell.
    const std::vector<Segment> walls = segments_of(all_straightened(rings));
    EXPECT_LE(walls.size(), 10u) << angle_rad;
    double true_m = 0;
    double length_m = 0;
    for (const Segment& wall : walls) {
      const double cosine = std::abs(wall.normal().dot(across));
      const double turned_rad =
          std::min(std::acos(std::min(1.0, cosine)), std::asin(std::min(1.0, cosine)));
      length_m += wall.length_m();
      if (turned_rad < (wall.length_m() > 50 ? 1 : 3) * kDegree_rad) true_m += wall.length_m();
    }
    EXPECT_GT(true_m, 0.9 * length_m) << angle_rad;
  }
}

TEST(StraightenedBorders, KeepWallsAlongTheCellsTheEndsOfThinOnesAndSmallThings) {
  const auto corners_of = [](const auto& is_occupied) {
    const auto rings = occupied_borders(map_where(40, is_occupied));
    return straightened(rings.at(0)).size();
  };
  const auto is_within = [](const Vector2d& point, double x, double y, double dx, double dy) {
    return point.x() > x && point.x() < x + dx && point.y() > y && point.y() < y + dy;
  };
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {2, 2}, {1, 3}, {1, 30}, {20, 9}}) {
    EXPECT_EQ(corners_of([&, w = width, h = height](const Vector2d& point) {
                return is_within(point, 5, 5, w, h);
              }),
              4u);
  }
  // A thin wall that stands on a thick one.
  EXPECT_EQ(corners_of([&](const Vector2d& point) {
              return is_within(point, 5, 5, 30, 4) || is_within(point, 15, 9, 1, 20);
            }),
            8u);
  // A cell of noise on a wall goes.
  EXPECT_EQ(corners_of([&](const Vector2d& point) {
              return is_within(point, 5, 5, 30, 4) || is_within(point, 15, 9, 1, 1);
            }),
            4u);
}

// Teeth of growing length, each farther than the last from the line through all: the worst case of
// halving at the farthest corner.
TEST(StraightenedBorders, OfAHostileCombTakeTimeInProportion) {
  const auto seconds_for = [](int num_teeth) {
    Ring ring;
    for (int i = 0; i < num_teeth; ++i) {
      ring.emplace_back(4 * i, 0);
      ring.emplace_back(4 * i, 3 + i);
      ring.emplace_back(4 * i + 2, 3 + i);
      ring.emplace_back(4 * i + 2, 0);
    }
    ring.emplace_back(4 * num_teeth, 0);
    ring.emplace_back(4 * num_teeth, -1);
    ring.emplace_back(0, -1);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_GE(straightened(ring).size(), static_cast<std::size_t>(4 * num_teeth));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  // Quadratic time would take minutes.
  EXPECT_LT(seconds_for(200'000), 5);
}

}  // namespace
}  // namespace corridor::simulation::testing
