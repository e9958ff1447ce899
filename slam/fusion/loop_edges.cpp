#include "slam/fusion/loop_edges.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "slam/fusion/submap.hpp"

namespace corridor::fusion {

namespace {

// (L^-1 + S)^-1 for an L that may be singular: what the closure says with the error of the submap's
// shape S on top.
Eigen::Matrix3d loosened(const Eigen::Matrix3d& L, const FusionParams& params) {
  const Eigen::Vector3d shape =
      Eigen::Vector3d(params.loop_sigma_m, params.loop_sigma_m, params.loop_sigma_rad).cwiseAbs2();
  const Eigen::Matrix3d sum = L + Eigen::Matrix3d(shape.cwiseInverse().asDiagonal());
  return L - L * sum.ldlt().solve(L);
}

}  // namespace

LoopEdges::Outcome LoopEdges::add(std::span<const LoopClosure> closures,
                                  backend::BackEnd& back_end) {
  std::vector<graph::NewFactor> factors;
  std::vector<const LoopClosure*> added;
  for (const LoopClosure& closure : closures) {
    const bool is_closed = std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
      return edge.scan_key == closure.scan_key;
    });
    if (is_closed) continue;
    factors.push_back(place_factor(closure.submap_frame, closure.scan_key, closure.match.T_map_base,
                                   loosened(closure.match.information, params_)));
    added.push_back(&closure);
  }
  Outcome solves;
  if (factors.empty()) return solves;
  solves.push_back(back_end.update(std::move(factors), {}, {}));
  for (std::size_t i = 0; i < added.size(); ++i) {
    const graph::FactorId id = solves.front().new_factor_ids[i];
    if (id != backend::kNoFactor)
      edges_.push_back({id, added[i]->scan_key, added[i]->path_m, added[i]->is_firm});
  }
  if (added.size() > 1) solves.push_back(back_end.solve());
  remove_false_ones(back_end, solves);
  return solves;
}

double LoopEdges::last_path_m() const {
  double last_m = 0;
  for (const Edge& edge : edges_) last_m = std::max(last_m, edge.path_m);
  return last_m;
}

void LoopEdges::remove_false_ones(backend::BackEnd& back_end, Outcome& solves) {
  const auto chi2 = [&](const Edge& edge) {
    // What a back-end has taken into a prior cannot be taken out any more.
    if (edge.is_firm || !back_end.graph().contains(edge.id)) return 0.0;
    return back_end.graph().chi2(edge.id, back_end.estimate());
  };
  while (true) {
    auto worst = edges_.end();
    double worst_chi2 = params_.loop_gate;
    for (auto edge = edges_.begin(); edge != edges_.end(); ++edge) {
      const double edge_chi2 = chi2(*edge);
      if (!(edge_chi2 > worst_chi2)) continue;
      worst = edge;
      worst_chi2 = edge_chi2;
    }
    if (worst == edges_.end()) return;
    solves.push_back(back_end.update({}, {}, {&worst->id, 1}));
    solves.push_back(back_end.solve());
    edges_.erase(worst);
    ++num_removed_;
  }
}

}  // namespace corridor::fusion
