// Where a catalogued data set lies. Internal to this folder.
#pragma once

#include <filesystem>
#include <optional>

#include "datasets/catalog/catalog.hpp"

namespace corridor::catalog {

// The first folder that has the log. Its other files count only if they lie in the same one: truth
// from elsewhere may belong to another version.
std::optional<std::filesystem::path> find_folder(const CatalogEntry& entry, const DataDirs& dirs);

bool is_file(const std::filesystem::path& path);

}  // namespace corridor::catalog
