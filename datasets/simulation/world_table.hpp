// The [world] table of a parsed document. Internal to this folder: it shows the TOML library.
#pragma once

#include <vector>

#include "datasets/simulation/toml_input.hpp"
#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

// Appends what is wrong; the world is fit only if nothing was.
World read_world_table(const toml::table& table, std::vector<TomlProblem>& problems);

}  // namespace corridor::simulation
