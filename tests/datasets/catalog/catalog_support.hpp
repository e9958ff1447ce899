// A tiny log with relations, and the catalogue that knows both.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "datasets/catalog/load_dataset.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::catalog::test {

using testing::ScratchFolder;

inline constexpr const char* kScans =
    "FLASER 2 1 2 0 0 0 0 0 0 1.0 h 1.0\nFLASER 2 1 60 0 0 0 0.1 0 0 1.5 h 1.5\n";
inline constexpr const char* kRelations = "1.0 1.5 0.1 0 0 0 0 0\n";
// sha256sum of the two texts above.
inline constexpr const char* kScansSha256 =
    "297417694ae3f01a8913e3f4ee4cfec52ae62be8d05a6aedb4098fb7dc4c9892";
inline constexpr const char* kRelationsSha256 =
    "297f188cfec31a6a215be422a3f615900e18b849adc6ae135db482545148895c";

inline std::string entry_text(const std::string& more = "", const std::string& name = "tiny") {
  return "[[dataset]]\nname = \"" + name +
         "\"\ntitle = \"A tiny log\"\nformat = \"carmen\"\nfiles = [\n"
         "  { path = \"sub/tiny.clf\", sha256 = \"" +
         kScansSha256 +
         "\" },\n"
         "  { path = \"sub/tiny.relations\", sha256 = \"" +
         kRelationsSha256 +
         "\" },\n]\n"
         "truth = \"relations\"\norder = \"stamp\"\nlicence = \"none stated\"\nsource = "
         "\"here\"\nnot_fetchable = \"made here\"\n" +
         more;
}

// A data folder with the tiny log, and its catalogue.
struct TinyData {
  TinyData() {
    folder.write("data/sub/tiny.clf", kScans);
    folder.write("data/sub/tiny.relations", kRelations);
    folder.write("catalog.toml", entry_text("no_return_range_m = 50.0\n"
                                            "calibration.wheels.track_m = 0.33\n"));
    dirs.folders = {folder / "elsewhere", folder / "data"};
  }
  [[nodiscard]] Catalog catalog() const { return *read_catalog(folder / "catalog.toml"); }

  ScratchFolder folder;
  DataDirs dirs;
};

// Calls with every catalogued log that this machine has; false where it has none.
template <class F>
bool for_each_log_found(F&& with_row) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  if (!catalog) throw std::runtime_error(catalog.error().to_line());
  const DataDirs dirs = standard_data_dirs();
  bool has_any = false;
  for (const DatasetRow& row : list_datasets(*catalog, dirs)) {
    if (!row.is_found || !row.is_readable) continue;
    with_row(row, *catalog, dirs);
    has_any = true;
  }
  return has_any;
}

inline constexpr const char* kNoData = "no data found; set $CORRIDOR_BENCH_DATA to their folder";

}  // namespace corridor::catalog::test
