#include "slam/fusion/loop_edges.hpp"

#include <algorithm>
#include <memory>

#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::fusion {

LoopEdges::Outcome LoopEdges::add(std::span<const LoopClosure> closures,
                                  backend::BackEnd& back_end) {
  std::vector<graph::FactorPtr> factors;
  for (const LoopClosure& closure : closures) {
    if (!closed_keys_.insert(closure.scan_key).second) continue;
    factors.push_back(std::make_unique<graph::RelativePose>(
        graph::pose_key(closure.submap_key), graph::pose_key(closure.scan_key),
        closure.match.T_map_base, graph::square_root_information(closure.match.information)));
  }
  Outcome outcome;
  if (factors.empty()) return outcome;
  outcome.solves.push_back(back_end.update(std::move(factors), {}, {}));
  const std::vector<graph::FactorId> added = outcome.solves.front().new_factor_ids;
  outcome.solves.push_back(back_end.solve());
  ids_.insert(ids_.end(), added.begin(), added.end());
  num_added_ += static_cast<int>(added.size());
  remove_false_ones(back_end, outcome);
  outcome.is_any_kept = std::any_of(added.begin(), added.end(), [&](graph::FactorId id) {
    return back_end.graph().contains(id);
  });
  return outcome;
}

void LoopEdges::remove_false_ones(backend::BackEnd& back_end, Outcome& outcome) {
  const auto chi2 = [&](graph::FactorId id) {
    return back_end.graph().factor(id).chi2(back_end.estimate());
  };
  while (!ids_.empty()) {
    const auto worst =
        std::max_element(ids_.begin(), ids_.end(),
                         [&](graph::FactorId a, graph::FactorId b) { return chi2(a) < chi2(b); });
    if (!(chi2(*worst) > gate_)) return;
    outcome.solves.push_back(back_end.update({}, {}, {&*worst, 1}));
    outcome.solves.push_back(back_end.solve());
    ids_.erase(worst);
    ++num_removed_;
  }
}

}  // namespace corridor::fusion
