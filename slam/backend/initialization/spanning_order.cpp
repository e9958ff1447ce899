#include "slam/backend/initialization/spanning_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <type_traits>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::backend {
namespace {

using graph::RelativePose;

struct Link {
  std::uint32_t other;
  const RelativePose* edge;
};

// The edges at every pose, side by side.
class Links {
 public:
  Links(const std::vector<const RelativePose*>& edges, std::uint32_t end_pose)
      : starts_(end_pose + 1, 0) {
    for (const RelativePose* edge : edges) {
      for (const graph::Key key : edge->keys()) {
        CORRIDOR_EXPECT(key.index < end_pose);
        ++starts_[key.index + 1];
      }
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    links_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (const RelativePose* edge : edges) {
      const std::uint32_t i = edge->keys()[0].index;
      const std::uint32_t j = edge->keys()[1].index;
      links_[next[i]++] = {j, edge};
      links_[next[j]++] = {i, edge};
    }
  }
  [[nodiscard]] std::span<const Link> of(std::uint32_t pose) const {
    return std::span(links_).subspan(starts_[pose], starts_[pose + 1] - starts_[pose]);
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<Link> links_;
};

std::vector<std::uint32_t> poses_of(const graph::Values& values) {
  std::vector<std::uint32_t> poses;
  for (const graph::Key key : values.keys()) {
    if (key.kind == graph::VariableKind::kPose) poses.push_back(key.index);
  }
  return poses;
}

class Growth {
 public:
  Growth(const Links& links, std::uint32_t end_pose) : links_(links), is_placed_(end_pose, false) {}

  void place(std::uint32_t pose, const RelativePose* edge) {
    if (is_placed_[pose]) return;
    is_placed_[pose] = true;
    order_.push_back({pose, edge});
    for (const Link& link : links_.of(pose)) {
      if (!is_placed_[link.other]) waiting_.push(link.other);
    }
  }
  void grow() {
    while (!waiting_.empty()) {
      const std::uint32_t pose = waiting_.top();
      waiting_.pop();
      if (!is_placed_[pose]) place(pose, edge_to_earlier(pose));
    }
  }
  [[nodiscard]] bool is_placed(std::uint32_t pose) const { return is_placed_[pose]; }
  std::vector<Placement> take_order() { return std::move(order_); }

 private:
  [[nodiscard]] const RelativePose* edge_to_earlier(std::uint32_t pose) const {
    // Poses below before those above, the nearer before the farther.
    const auto rank = [pose](std::uint32_t other) {
      return std::pair(other > pose, other > pose ? other - pose : pose - other);
    };
    const Link* best = nullptr;
    for (const Link& link : links_.of(pose)) {
      if (!is_placed_[link.other]) continue;
      if (best == nullptr || rank(link.other) < rank(best->other)) best = &link;
    }
    return best->edge;
  }

  const Links& links_;
  std::vector<bool> is_placed_;
  std::vector<Placement> order_;
  // Poses with an edge to a placed one, the lowest on top.
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> waiting_;
};

}  // namespace

std::uint32_t Placement::parent() const {
  CORRIDOR_EXPECT(edge != nullptr);
  const auto& keys = edge->keys();
  return keys[0].index == pose ? keys[1].index : keys[0].index;
}

Pose2 Placement::T_parent_pose() const {
  CORRIDOR_EXPECT(edge != nullptr);
  const Pose2& T_i_j = edge->measured_T_i_j();
  return edge->keys()[1].index == pose ? T_i_j : T_i_j.inverse();
}

std::vector<const RelativePose*> relative_poses(const graph::FactorGraph& graph) {
  std::vector<std::pair<graph::FactorId, const RelativePose*>> numbered;
  graph.for_each([&]<class F>(graph::FactorId id, const F& factor, const graph::RobustKernel&) {
    if constexpr (std::is_same_v<F, RelativePose>) numbered.emplace_back(id, &factor);
  });
  std::sort(numbered.begin(), numbered.end());
  std::vector<const RelativePose*> edges;
  edges.reserve(numbered.size());
  for (const auto& [id, edge] : numbered) edges.push_back(edge);
  return edges;
}

Result<std::vector<Placement>> spanning_order(const graph::FactorGraph& graph,
                                              const graph::Values& values,
                                              std::span<const std::uint32_t> held) {
  const std::vector<std::uint32_t> poses = poses_of(values);
  if (poses.empty()) return std::vector<Placement>();
  const std::uint32_t end_pose = poses.back() + 1;
  const Links links(relative_poses(graph), end_pose);
  Growth growth(links, end_pose);
  for (const std::uint32_t pose : held) {
    CORRIDOR_EXPECT(values.contains(graph::pose_key(pose)));
    growth.place(pose, nullptr);
  }
  if (held.empty()) growth.place(poses.front(), nullptr);
  growth.grow();
  const auto is_lost = [&](std::uint32_t pose) { return !growth.is_placed(pose); };
  const auto lost = std::find_if(poses.begin(), poses.end(), is_lost);
  if (lost == poses.end()) return growth.take_order();
  return fail(ErrorCode::kInvalid,
              fmt::format("pose {} cannot be reached from pose {} ({} of {} poses cannot)", *lost,
                          held.empty() ? poses.front() : held.front(),
                          std::count_if(lost, poses.end(), is_lost), poses.size()),
              "", "edges that join every pose to one that is held");
}

}  // namespace corridor::backend
