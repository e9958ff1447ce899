#include "reports/report.hpp"

#include <string>

#include "datasets/formats/atomic_file.hpp"
#include "reports/cases.hpp"
#include "reports/escape.hpp"
#include "reports/figures/raster.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/html/page.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::reports {
namespace {

namespace fs = std::filesystem;

// Pixels of the PNG per pixel of the figure: 960 px become 16 cm at 300 dpi.
constexpr double kPngScale = 2;

Result<void> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return {};
  return fail(ErrorCode::kUnreadable, "cannot make this folder: " + error.message(),
              folder.string());
}

Result<void> write_table(const tables::Table& table, const fs::path& folder) {
  const std::string stem = file_name_from(table.id);
  return formats::write_file_atomically(folder / (stem + ".md"), tables::to_markdown(table))
      .and_then([&] {
        return formats::write_file_atomically(folder / (stem + ".csv"), tables::to_csv(table));
      })
      .and_then([&] {
        return formats::write_file_atomically(folder / (stem + ".tex"), tables::to_latex(table));
      });
}

Result<void> write_figure(const figures::Figure& figure, const fs::path& folder) {
  const std::string stem = file_name_from(figure.svg.id());
  const std::string svg = figure.svg.file();
  if (auto written = formats::write_file_atomically(folder / (stem + ".svg"), svg); !written) {
    return written;
  }
  const auto png = figures::png_from_svg(svg, kPngScale);
  if (!png) return tl::make_unexpected(png.error());
  return formats::write_file_atomically(folder / (stem + ".png"), *png);
}

}  // namespace

Result<void> write_report(const std::vector<fs::path>& run_dirs, const fs::path& out) {
  const auto cases = load_cases(run_dirs);
  if (!cases) return tl::make_unexpected(cases.error());
  for (const char* folder : {"tables", "figures"}) {
    if (auto made = make_folder(out / folder); !made) return made;
  }
  const std::vector<tables::Table> all_tables = tables::report_tables(*cases);
  for (const tables::Table& table : all_tables) {
    if (auto written = write_table(table, out / "tables"); !written) return written;
  }
  std::vector<std::string> problems;
  const std::vector<figures::Figure> all_figures = figures::report_figures(*cases, problems);
  for (const figures::Figure& figure : all_figures) {
    if (auto written = write_figure(figure, out / "figures"); !written) return written;
  }
  const auto page = html::render_page({&*cases, &all_tables, &all_figures, &problems, out});
  if (!page) return tl::make_unexpected(page.error());
  return formats::write_file_atomically(out / "index.html", std::string_view(*page));
}

}  // namespace corridor::reports
