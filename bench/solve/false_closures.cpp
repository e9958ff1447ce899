#include "bench/solve/false_closures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/solve/held_poses.hpp"
#include "slam/backend/robust/loop_closures.hpp"
#include "slam/core/expect.hpp"

namespace corridor::solve {
namespace {

using formats::PoseGraph;

// Two poses by their place in the drive, first < second.
using Pair = std::pair<std::size_t, std::size_t>;

// Consecutive ones would be odometry.
constexpr std::size_t kNearest = 2;

// The first of the pair lies in [0, end), the second in [first + kNearest, end).
Pair draw_pair(std::size_t end, FalsePairs pairs, Rng& rng) {
  if (pairs == FalsePairs::kLocal) {
    const std::size_t first = rng.below(end - kNearest);
    const std::size_t last = std::min(end, first + kLocalReach + 1);
    return {first, first + kNearest + rng.below(last - first - kNearest)};
  }
  while (true) {
    const auto [first, second] = std::minmax({rng.below(end), rng.below(end)});
    if (second - first >= kNearest) return {first, second};
  }
}

}  // namespace

std::string_view to_text(FalsePairs pairs) {
  constexpr std::string_view kNames[] = {"random", "local", "grouped"};
  return kNames[static_cast<std::size_t>(pairs)];
}

Result<PoseGraph> with_false_closures(PoseGraph graph, double share, FalsePairs pairs,
                                      const Rng& rng) {
  CORRIDOR_EXPECT(share >= 0 && share < 1);
  const std::size_t group = pairs == FalsePairs::kGrouped ? kGroupSize : 1;
  if (graph.vertices.size() < kNearest + group) {
    return fail(ErrorCode::kInvalid, "too few poses for false loop closures", "",
                "a drive of some length");
  }
  const formats::GraphProblem problem = formats::factor_graph_of(graph);
  const auto closures = backend::loop_closures(problem.factors, problem.values, held_poses(graph));
  if (!closures) return tl::make_unexpected(closures.error());
  if (closures->empty()) {
    return fail(ErrorCode::kInvalid, "no loop closures that false ones could imitate", "",
                "a graph with closures");
  }
  std::vector<std::uint32_t> drive;
  for (const PoseGraph::Vertex& vertex : graph.vertices) drive.push_back(vertex.id);
  std::sort(drive.begin(), drive.end());
  const auto num_own = static_cast<double>(closures->size());
  const auto num_false = static_cast<std::size_t>(std::lround(num_own * share / (1 - share)));
  Rng draw = rng.stream("false closures");
  for (std::size_t done = 0; done < num_false;) {
    const Pair pair = draw_pair(drive.size() - group + 1, pairs, draw);
    const PoseGraph::Edge model = graph.edges[(*closures)[draw.below(closures->size())]];
    for (std::size_t k = 0; k < group && done < num_false; ++k, ++done) {
      graph.edges.push_back(
          {drive[pair.first + k], drive[pair.second + k], model.T_i_j, model.information});
    }
  }
  return graph;
}

RejectionScore score_of(std::span<const graph::FactorId> rejected, std::size_t first_false,
                        std::size_t num_edges) {
  RejectionScore score;
  if (first_false == num_edges) return score;
  const auto hits = static_cast<double>(std::count_if(
      rejected.begin(), rejected.end(), [&](graph::FactorId id) { return id >= first_false; }));
  if (!rejected.empty()) score.precision = hits / static_cast<double>(rejected.size());
  score.recall = hits / static_cast<double>(num_edges - first_false);
  return score;
}

}  // namespace corridor::solve
