#include "bench/solve/pose_graph_steps.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace corridor::solve {
namespace {

using backend::Placement;

// The edges that arrive with every pose: those to poses placed before it.
std::vector<std::vector<graph::FactorId>> edges_by_arrival(const Problem& problem,
                                                           const std::vector<Placement>& order) {
  std::vector<std::size_t> arrival;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k].pose >= arrival.size()) arrival.resize(order[k].pose + 1);
    arrival[order[k].pose] = k;
  }
  std::vector<std::vector<graph::FactorId>> edges(order.size());
  for (graph::FactorId id = 0; id < problem.graph.factors.end_id(); ++id) {
    const std::span<const graph::Key> keys = problem.graph.factors.keys(id);
    edges[std::max(arrival[keys[0].index], arrival[keys[1].index])].push_back(id);
  }
  return edges;
}

// The prior, if the pose is held, and the edges that arrive with the k-th pose. Held poses come
// first, in the order of their priors.
std::vector<graph::NewFactor> factors_of(const Problem& problem, std::size_t k,
                                         const std::vector<graph::FactorId>& edges) {
  std::vector<graph::NewFactor> factors;
  if (k < problem.priors.size()) factors.push_back(problem.priors[k]);
  for (const graph::FactorId id : edges) factors.push_back(problem.edge(id));
  return factors;
}

}  // namespace

Result<Steps> pose_graph_steps(const Problem& problem, int poses_per_update) {
  auto order = backend::spanning_order(problem.graph.factors, problem.graph.values, problem.held);
  if (!order) return tl::make_unexpected(order.error());
  auto arrivals = edges_by_arrival(problem, *order);
  const std::size_t num_poses = order->size();
  const auto every = static_cast<std::size_t>(poses_per_update);
  const auto at = [&problem, every, order = std::move(*order),
                   arrivals = std::move(arrivals)](std::size_t k) {
    const std::uint32_t pose = order[k].pose;
    Step step;
    step.call = (k + 1) % every == 0 || k + 1 == order.size() ? Call::kUpdate : Call::kAdd;
    step.factors = factors_of(problem, k, arrivals[k]);
    if (order[k].edge != nullptr) {
      step.placement = order[k];
    } else {
      step.values.set_pose(pose, problem.graph.values.pose(pose));
    }
    step.reading = {pose, k + 1, step.call == Call::kUpdate};
    return step;
  };
  return Steps{num_poses, at};
}

}  // namespace corridor::solve
