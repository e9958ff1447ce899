// One case that solves a pose graph, from its spec to its folder: graph, back-end, solution, gap to
// the best that is known, files. run_case() hands these cases over.
#pragma once

#include <filesystem>
#include <optional>

#include "bench/runner/run_case.hpp"

namespace corridor::runner {

// As run_case(). Requires data_kind kGraph.
tl::expected<results::RunResult, CaseFailure> run_graph_case(const CaseSpec& spec,
                                                             const catalog::DataDirs& dirs,
                                                             const std::filesystem::path& out,
                                                             std::optional<int> jobs);

}  // namespace corridor::runner
