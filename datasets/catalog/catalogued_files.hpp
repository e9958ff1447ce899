// The files of an entry on this machine. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::catalog {

// The folder that has the entry's first file; the Error says how to get it.
Result<std::filesystem::path> folder_of(const CatalogEntry& entry, const DataDirs& dirs);

// Every file of the entry must be there and be the catalogue's; otherwise a result would carry the
// name of data it was not made from. Returns a line for each other file that was let through.
Result<std::vector<std::string>> check_files(const CatalogEntry& entry,
                                             const std::filesystem::path& folder,
                                             bool accept_other_checksum);

}  // namespace corridor::catalog
