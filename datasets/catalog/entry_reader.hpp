// One [[dataset]] table of a catalogue. Internal to this folder: it shows the TOML library.
#pragma once

#include <toml++/toml.h>

#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "datasets/formats/toml_problems.hpp"

namespace corridor::catalog {

// Appends what is wrong; the entry is fit only if nothing was.
CatalogEntry read_entry(const toml::table& table, std::vector<formats::TomlProblem>& problems);

}  // namespace corridor::catalog
