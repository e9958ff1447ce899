// A Manhattan-like world: a robot that walks the streets of a grid, a metre per pose, with a
// closure wherever it stands again where it stood. With these numbers the graph of 3500 poses has
// 5000 edges and 12 Mflop of block factorisation; M3500 5500 and 9.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numbers>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::micro {

struct ManhattanWalk {
  struct Edge {
    std::uint32_t i, j;  // i < j
  };
  std::vector<Pose2> true_poses;
  std::vector<Edge> edges;  // those of pose j after those of pose j - 1, odometry first
};

inline ManhattanWalk walk_manhattan(Rng& rng, std::uint32_t num_poses) {
  constexpr int kHalfWidth = 25;  // of the square of crossings; at its edge it turns round
  constexpr double kTurnProbability = 0.25;  // at every crossing, left or right alike
  constexpr double kClosureProbability = 0.9;
  constexpr std::array<std::array<int, 2>, 4> kHeadings{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  std::map<std::array<int, 2>, std::uint32_t> last_visit;  // pose that stood at a crossing last
  ManhattanWalk walk;
  std::array<int, 2> crossing{};
  std::size_t heading = 0;
  for (std::uint32_t pose = 0; pose < num_poses; ++pose) {
    walk.true_poses.emplace_back(crossing[0], crossing[1],
                                 static_cast<double>(heading) * std::numbers::pi / 2);
    if (pose > 0) walk.edges.push_back({pose - 1, pose});
    const auto visited = last_visit.find(crossing);
    if (visited != last_visit.end() && rng.uniform() < kClosureProbability) {
      walk.edges.push_back({visited->second, pose});
    }
    last_visit[crossing] = pose;
    if (rng.uniform() < kTurnProbability) heading = (heading + (rng.uniform() < 0.5 ? 1 : 3)) % 4;
    const auto ahead = [&](std::size_t axis) { return crossing[axis] + kHeadings[heading][axis]; };
    if (std::max(std::abs(ahead(0)), std::abs(ahead(1))) > kHalfWidth) heading = (heading + 2) % 4;
    crossing = {ahead(0), ahead(1)};
  }
  return walk;
}

}  // namespace corridor::micro
