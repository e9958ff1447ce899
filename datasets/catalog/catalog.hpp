// The data sets the suite knows by name, and where their files lie.
// It loads none (load_dataset.hpp does) and downloads nothing (fetch.hpp does).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/log_io.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::catalog {

// Folders that are searched, in this order.
struct DataDirs {
  std::vector<std::filesystem::path> folders;
};

// `data_dir` (the option --data-dir), $CORRIDOR_BENCH_DATA, the user's cache folder
// ($XDG_CACHE_HOME/corridor-bench or ~/.cache/corridor-bench), what Debian's mrpt-common installs.
DataDirs standard_data_dirs(const std::optional<std::filesystem::path>& data_dir = {});

// $XDG_CACHE_HOME/corridor-bench or ~/.cache/corridor-bench; nullopt without either variable.
std::optional<std::filesystem::path> cache_folder();

// kReference: poses in the log itself that another program found while it was recorded; good for
// comparing with that program, no truth.
enum class TruthKind { kNone, kTum, kRelations, kReference };
std::string_view to_text(TruthKind kind);

struct DataFile {
  std::filesystem::path path;  // relative to a data folder
  std::string sha256;          // lower-case hexadecimal
  // True: the sum is that of the content without gzip, which publisher and folder may pack each in
  // their own way; a path that ends in .gz is kept packed. False: it is that of the file's bytes.
  bool is_sum_of_content = false;
  std::string url;  // where the public gets it; empty: nowhere, see CatalogEntry::not_fetchable
};

struct CatalogEntry {
  std::string name;
  std::string title;
  std::string format;  // "rawlog", "carmen", "lcm", "ticks", "rosbag"; graphs: "g2o", "toro"
  std::vector<DataFile> files;  // the first is the log or the graph
  TruthKind truth = TruthKind::kNone;
  std::string licence;  // as its publisher states it
  std::string source;   // where it comes from
  // Why `data fetch` cannot get it; empty if every file has a URL.
  std::string not_fetchable;
  // What belongs to it and is not read with it: another form of the log, what other programs made
  // of it. Never fetched, for the reason that is stated.
  std::vector<DataFile> companions;
  std::string companions_not_fetchable;
  formats::StampOrder order = formats::StampOrder::kStamp;
  // Of files with another checksum, where they are accepted: canonical logs may keep their rows in
  // order and not their stamps.
  std::optional<formats::StampOrder> order_of_other_files;
  std::optional<double> no_return_range_m;
  std::optional<double> cut_after_s;
  std::optional<RobotModel> robot;  // calibration for logs that carry none
  formats::RobotKeys robot_keys;    // what it states
  formats::RawSensors raw;
  std::optional<formats::BagTopics> topics;  // of a ROS bag
  std::optional<double> best_chi2;           // of a graph: the smallest that is known
  std::string best_chi2_source;              // who found it, and how sure that is
  // Where it is stated, and the data folder that alone has its files; none: any data folder.
  std::filesystem::path catalog_file;
  std::uint32_t line = 0;
  std::optional<std::filesystem::path> folder;

  [[nodiscard]] bool is_graph() const;  // else a sensor log
  // The suffixes of the files that lie beside the log, of formats::kSidecarSuffixes.
  [[nodiscard]] std::vector<std::string> sidecars() const;
};

struct Catalog {
  std::vector<CatalogEntry> entries;
  [[nodiscard]] const CatalogEntry* find(std::string_view name) const;
};

// The catalog.toml of the source tree the program was built from; $CORRIDOR_BENCH_CATALOG
// overrides.
std::filesystem::path main_catalog_path();

// The Error lists every violation with its line: unknown keys, missing keys, names given twice, bad
// checksums, formats and truth that do not fit the files.
Result<Catalog> read_catalog(const std::filesystem::path& path);

// The main catalogue and, after it, the catalog.toml of each data folder that has one. A name that
// two of them have is an Error that names both places.
Result<Catalog> known_datasets(const DataDirs& dirs);

struct DatasetRow {
  std::string name;
  std::string title;
  bool is_found = false;       // every file of the entry
  bool is_readable = false;    // as a sensor log
  std::filesystem::path path;  // of the log, where it was found
  // As catalogued, of those beside a log that was found: the entry is incomplete without them.
  std::vector<std::filesystem::path> missing_files;
  std::string format;
  TruthKind truth = TruthKind::kNone;
  std::string licence;
  std::string source;
  bool is_fetchable = false;
  std::string not_fetchable;  // why
  std::filesystem::path catalog_file;
  bool is_own = false;  // of the catalogue of a data folder
};

// One row per entry, in the catalogue's order.
std::vector<DatasetRow> list_datasets(const Catalog& catalog, const DataDirs& dirs);

enum class FileStatus { kMatches, kDiffers, kMissing };
std::string_view to_text(FileStatus status);

struct VerifiedFile {
  std::filesystem::path path;  // where it was found, else as catalogued
  FileStatus status = FileStatus::kMissing;
  std::string sha256;  // found, by the rule of DataFile; empty if missing
  std::string sha256_expected;
};

// A name that the catalogue does not have, with the nearest ones.
Error unknown_dataset(const Catalog& catalog, std::string_view name);

// Compares every file of an entry with the catalogue, and those companions that are there. An Error
// for an unknown name.
Result<std::vector<VerifiedFile>> verify_dataset(const Catalog& catalog, std::string_view name,
                                                 const DataDirs& dirs);

}  // namespace corridor::catalog
