#include "datasets/simulation/manhattan_walk.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <map>
#include <numbers>

namespace corridor::simulation {
namespace {

constexpr double kPositionSigma_m = 0.05;
constexpr double kAngleSigma_rad = 0.02;
constexpr std::uint32_t kMinWalkPoses = 2;

// Takes a number without sign or leading zeros off the front: every walk has one name.
template <class T>
bool take_number(std::string_view& text, T& number) {
  if (text.empty() || text.front() < '1' || text.front() > '9') return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_text(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

}  // namespace

ManhattanWalk walk_manhattan(Rng& rng, std::uint32_t num_poses) {
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

std::optional<WalkName> walk_name_from(std::string_view name) {
  WalkName walk;
  const bool is_walk = take_text(name, "walk-") && take_number(name, walk.num_poses) &&
                       take_text(name, "-s") && take_number(name, walk.seed) && name.empty();
  if (!is_walk || walk.num_poses < kMinWalkPoses || walk.num_poses > kMaxWalkPoses) {
    return std::nullopt;
  }
  return walk;
}

WalkGraph walk_graph(const WalkName& name) {
  Rng rng(name.seed);
  const ManhattanWalk walk = walk_manhattan(rng, name.num_poses);
  const Eigen::Vector3d sigma(kPositionSigma_m, kPositionSigma_m, kAngleSigma_rad);
  const Eigen::Matrix3d information = sigma.array().square().inverse().matrix().asDiagonal();
  WalkGraph made{{}, walk.true_poses};
  made.graph.vertices.push_back({0, walk.true_poses.front()});
  for (const auto& [i, j] : walk.edges) {
    const Pose2 T_i_j =
        walk.true_poses[i]
            .between(walk.true_poses[j])
            .plus({rng.normal(0, sigma(0)), rng.normal(0, sigma(1)), rng.normal(0, sigma(2))});
    // A pose's first edge is its odometry.
    if (made.graph.vertices.size() == j) {
      made.graph.vertices.push_back({j, made.graph.vertices[i].T_map_base * T_i_j});
    }
    made.graph.edges.push_back({i, j, T_i_j, information});
  }
  return made;
}

}  // namespace corridor::simulation
