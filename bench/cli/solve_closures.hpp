// False loop closures in `solve`: planted ones, and what is said of those that were rejected.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/solve/false_closures.hpp"
#include "bench/solve/solve_graph.hpp"

namespace corridor::cli {

// Plants false closures; how many. `seed` is the text of the option.
Result<std::size_t> plant(formats::PoseGraph& graph, double share, solve::FalsePairs pairs,
                          const std::string& seed);

// Number of rejected edges; precision and recall where false ones were planted.
void add_rejection(std::size_t num_edges, const solve::SolveOptions& options,
                   const solve::SolveRun& run, nlohmann::ordered_json& json);

// A line per rejected edge: its number among the edges, from 0, its poses, its chi2 at the
// solution, whether it was planted. Requires that the run has rejected edges, be it none.
Result<void> write_rejected(const std::string& file, const formats::PoseGraph& graph,
                            const solve::SolveRun& run, const graph::Values& solution,
                            std::size_t num_planted);

}  // namespace corridor::cli
