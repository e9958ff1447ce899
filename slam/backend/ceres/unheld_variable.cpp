#include "slam/backend/ceres/unheld_variable.hpp"

#include <cstddef>
#include <vector>

#include "slam/core/disjoint_sets.hpp"

namespace corridor::backend {
namespace {

using graph::Key;
using graph::VariableKind;

struct Part {
  bool has_pose = false;
  bool has_held_pose = false;
  bool has_held_variable = false;

  [[nodiscard]] bool is_held() const { return has_pose ? has_held_pose : has_held_variable; }
};

}  // namespace

std::optional<Key> find_unheld_variable(const graph::FactorGraph& graph,
                                        const graph::VariableIndex& variables) {
  const auto number_of = [&](Key key) { return static_cast<std::size_t>(variables.of(key)); };
  DisjointSets joined(variables.keys().size());
  graph.for_each([&](graph::FactorId, const auto& factor, const graph::RobustKernel&) {
    const std::size_t first = number_of(factor.keys()[0]);
    for (const Key key : factor.keys()) joined.join(first, number_of(key));
  });
  std::vector<Part> parts(variables.keys().size());  // by root
  const auto part_of = [&](Key key) -> Part& { return parts[joined.root_of(number_of(key))]; };
  for (const Key key : variables.keys()) {
    if (key.kind == VariableKind::kPose) part_of(key).has_pose = true;
  }
  graph.for_each([&]<class F>(graph::FactorId, const F& factor, const graph::RobustKernel&) {
    // What is left of marginalised factors holds its variables as priors do.
    if (graph::kIsFixed<F> && factor.keys().size() > 1) return;
    for (const Key key : factor.keys()) {
      Part& part = part_of(key);
      part.has_held_variable = true;
      if (key.kind == VariableKind::kPose) part.has_held_pose = true;
    }
  });
  for (const Key key : variables.keys()) {
    if (!part_of(key).is_held()) return key;
  }
  return std::nullopt;
}

}  // namespace corridor::backend
