// Whether what an entry says about its files (format, truth) fits their names. Internal to this
// folder.
#pragma once

#include <string>
#include <vector>

#include "datasets/catalog/catalog.hpp"

namespace corridor::catalog {

struct EntryProblem {
  std::string key;
  std::string what;
};

// Requires that the entry has files. Only what is listed is read with a log, so that truth that is
// claimed must be listed, and truth that is listed claimed.
std::vector<EntryProblem> unfit_files(const CatalogEntry& entry);

}  // namespace corridor::catalog
