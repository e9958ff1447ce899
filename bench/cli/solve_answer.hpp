// What `solve` answers: one JSON document, or a table of the same values.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/cli/solve_command.hpp"
#include "bench/solve/solve_graph.hpp"
#include "slam/core/params.hpp"

namespace corridor::cli {

// `parameters`: all that the back-end had; `overrides`: those of them that were set by hand.
nlohmann::ordered_json to_json(const SolveCommand& command, const ParamValues& parameters,
                               const ParamValues& overrides, const formats::PoseGraph& graph,
                               const solve::SolveOptions& options, const solve::SolveRun& run);
std::string to_text(const nlohmann::ordered_json& run);

}  // namespace corridor::cli
