// One [[dataset]] table of a catalogue. Internal to this folder: it shows the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "datasets/catalog/catalog.hpp"

namespace corridor::catalog {

// "line 12: colour: unknown key", in the line of the key where it is there.
std::string line_text(const toml::node& node, std::string_view key, std::string_view what);

// Appends what is wrong; the entry is fit only if nothing was.
CatalogEntry read_entry(const toml::table& table, std::vector<std::string>& wrong);

}  // namespace corridor::catalog
