#include "bench/cli/solve_closures.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/cli/command.hpp"
#include "datasets/formats/atomic_file.hpp"

namespace corridor::cli {

using Json = nlohmann::ordered_json;

Result<std::size_t> plant(formats::PoseGraph& graph, double share, solve::FalsePairs pairs,
                          const std::string& seed) {
  const Result<std::uint64_t> number = seed_from_text(seed);
  if (!number) return tl::make_unexpected(number.error());
  const std::size_t num_own = graph.edges.size();
  auto planted = solve::with_false_closures(graph, share, pairs, Rng(*number));
  if (!planted) return tl::make_unexpected(planted.error());
  graph = std::move(*planted);
  return graph.edges.size() - num_own;
}

void add_rejection(std::size_t num_edges, const solve::SolveOptions& options,
                   const solve::SolveRun& run, nlohmann::ordered_json& json) {
  json["inlier_probability"] = run.rejected ? Json(options.inlier_probability) : Json();
  json["rejected_edges"] = run.rejected ? Json(run.rejected->size()) : Json();
  json["false_closures"] = options.num_planted > 0 ? Json(options.num_planted) : Json();
  solve::RejectionScore score;
  if (run.rejected) {
    score = solve::score_of(*run.rejected, num_edges - options.num_planted, num_edges);
  }
  json["rejection_precision"] = score.precision ? Json(*score.precision) : Json();
  json["rejection_recall"] = score.recall ? Json(*score.recall) : Json();
}

Result<void> write_rejected(const std::string& file, const formats::PoseGraph& graph,
                            const solve::SolveRun& run, const graph::Values& solution,
                            std::size_t num_planted) {
  const formats::GraphProblem problem = formats::factor_graph_of(graph);
  std::string text = "edge,pose_i,pose_j,chi2,planted\n";
  for (const graph::FactorId id : *run.rejected) {
    const formats::PoseGraph::Edge& edge = graph.edges[id];
    const bool is_planted = id >= graph.edges.size() - num_planted;
    text += fmt::format("{},{},{},{},{}\n", id, edge.i, edge.j, problem.factors.chi2(id, solution),
                        is_planted ? 1 : 0);
  }
  return formats::write_file_atomically(file, text);
}

}  // namespace corridor::cli
