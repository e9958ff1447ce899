// What a name that is given as data means: a scenario to simulate, a recording, or a pose graph.
#pragma once

#include <string>

#include "bench/runner/case_spec.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

// An Error for a name that a data set has and either a scenario or the graph of a system.
Result<void> check_one_meaning(const std::string& name_or_path, const catalog::Catalog& known);

// Simulated: a scenario's name or .toml file, with or without a family's member. Recorded: a data
// set's name, or a file. Graph: likewise, by its format or suffix, the name of a walk, and the
// graph of a system (graph_of.hpp), if it is well spelt. The Error for what is none of them says
// the nearest names.
Result<DataKind> kind_of_data(const std::string& name_or_path, const catalog::Catalog& known);

}  // namespace corridor::runner
