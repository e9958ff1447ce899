// True poses beside a pose graph of three poses. What was taken is finite and one per pose, and the
// same after being written and read again.
#include "datasets/formats/graphs/true_poses.hpp"

#include <fmt/format.h>

#include <string>

#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {
namespace {

formats::PoseGraph graph_of_three() {
  formats::PoseGraph graph;
  for (const std::uint32_t id : {7U, 2U, 5U}) graph.vertices.push_back({id, {}});
  return graph;
}

}  // namespace

bool true_poses(std::string_view bytes) {
  const formats::PoseGraph graph = graph_of_three();
  const auto poses = formats::parse_true_poses(bytes, graph, "a.truth-nodes.dat");
  if (!poses) return false;
  CORRIDOR_EXPECT(poses->size() == graph.vertices.size());
  std::string text;
  for (const auto& pose : *poses) {
    const Pose2& at = pose.T_map_base;
    CORRIDOR_EXPECT(at.is_finite());
    text += fmt::format("{} {} {}\n", at.x_m(), at.y_m(), at.theta_rad());
  }
  const auto again = formats::parse_true_poses(text, graph, "a.truth-nodes.dat");
  CORRIDOR_EXPECT(again.has_value());
  for (std::size_t k = 0; k < poses->size(); ++k) {
    CORRIDOR_EXPECT((*again)[k].id == (*poses)[k].id);
    CORRIDOR_EXPECT((*again)[k].T_map_base == (*poses)[k].T_map_base);
  }
  return true;
}

}  // namespace corridor::fuzz
