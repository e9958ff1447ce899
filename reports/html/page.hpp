// index.html: one file with everything in it, no script, no network.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/cases.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/tables/table.hpp"
#include "slam/core/result.hpp"

namespace corridor::html {

struct PageContent {
  const reports::Cases* cases = nullptr;
  const std::vector<tables::Table>* tables = nullptr;
  const std::vector<figures::Figure>* figures = nullptr;
  // Files that could not be read, one line each.
  const std::vector<std::string>* problems = nullptr;
  std::filesystem::path out;  // links are relative to it
};

// The page's Content-Security-Policy allows images from data: URLs and the one style sheet by its
// hash, nothing else.
Result<std::string> render_page(const PageContent& content);

}  // namespace corridor::html
