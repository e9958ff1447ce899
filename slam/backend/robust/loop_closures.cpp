#include "slam/backend/robust/loop_closures.hpp"

#include <algorithm>
#include <type_traits>
#include <unordered_set>

#include "slam/backend/initialization/spanning_order.hpp"

namespace corridor::backend {

Result<std::vector<graph::FactorId>> loop_closures(const graph::FactorGraph& graph,
                                                   const graph::Values& values,
                                                   std::span<const std::uint32_t> held) {
  const auto order = spanning_order(graph, values, held);
  if (!order) return tl::make_unexpected(order.error());
  std::unordered_set<const graph::RelativePose*> tree;
  for (const Placement& step : *order) tree.insert(step.edge);
  std::vector<graph::FactorId> closures;
  graph.for_each([&]<class F>(graph::FactorId id, const F& factor, const graph::RobustKernel&) {
    if constexpr (std::is_same_v<F, graph::RelativePose>) {
      if (!tree.contains(&factor)) closures.push_back(id);
    }
  });
  std::sort(closures.begin(), closures.end());
  return closures;
}

}  // namespace corridor::backend
