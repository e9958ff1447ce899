#include "bench/solve/held_poses.hpp"

#include <algorithm>
#include <unordered_map>

namespace corridor::solve {
namespace {

// Information of the prior on one of several held poses, as a multiple of its edges': it gives way
// by a millionth of what they pull.
constexpr double kHoldRatio = 1e6;

struct Hold {
  double position = 0;  // largest information of the pose's edges [1/m^2]
  double heading = 0;   // [1/rad^2]
};

Eigen::Matrix3d square_root_of(const Hold& hold, double ratio) {
  const auto root = [ratio](double information) {
    return std::sqrt(ratio * (information > 0 ? information : 1.0));
  };
  const double position = root(hold.position);
  return Eigen::Vector3d(position, position, root(hold.heading)).asDiagonal();
}

}  // namespace

std::vector<std::uint32_t> held_poses(const formats::PoseGraph& graph) {
  if (!graph.fixed.empty()) return graph.fixed;
  const auto is_lower = [](const auto& a, const auto& b) { return a.id < b.id; };
  return {std::min_element(graph.vertices.begin(), graph.vertices.end(), is_lower)->id};
}

std::vector<graph::PosePrior> priors_on(const std::vector<std::uint32_t>& held,
                                        const formats::PoseGraph& graph,
                                        const graph::Values& values) {
  std::unordered_map<std::uint32_t, Hold> holds;
  for (const std::uint32_t pose : held) holds[pose] = {};
  for (const formats::PoseGraph::Edge& edge : graph.edges) {
    const Eigen::Vector3d diagonal = edge.information.diagonal();
    for (const std::uint32_t pose : {edge.i, edge.j}) {
      const auto found = holds.find(pose);
      if (found == holds.end()) continue;
      Hold& hold = found->second;
      hold.position = std::max({hold.position, diagonal(0), diagonal(1)});
      hold.heading = std::max(hold.heading, diagonal(2));
    }
  }
  // Edges leave the motion of the whole graph free, so that a prior alone is met exactly, however
  // weak it is; a strong one would only cost digits.
  const double ratio = held.size() == 1 ? 1 : kHoldRatio;
  std::vector<graph::PosePrior> priors;
  for (const std::uint32_t pose : held) {
    priors.emplace_back(graph::pose_key(pose), values.pose(pose),
                        square_root_of(holds[pose], ratio));
  }
  return priors;
}

}  // namespace corridor::solve
