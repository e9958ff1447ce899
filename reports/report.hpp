// The report on one or more run directories: tables, figures and the page. Reads results only,
// never a system; the same results give the same bytes.
#pragma once

#include <filesystem>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::reports {

// Writes tables/*.md *.csv *.tex, figures/*.svg *.png and index.html into `out`, which is made if
// need be and may be one of the run directories. An Error if a run directory is missing or holds no
// result.
Result<void> write_report(const std::vector<std::filesystem::path>& run_dirs,
                          const std::filesystem::path& out);

}  // namespace corridor::reports
