// The data sets the suite knows by name, where their files lie, and how to load one.
// It downloads nothing (fetch.hpp does) and decides nothing about scoring.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"

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
  formats::StampOrder order = formats::StampOrder::kStamp;
  // Of files with another checksum, where they are accepted: canonical logs may keep their rows in
  // order and not their stamps.
  std::optional<formats::StampOrder> order_of_other_files;
  std::optional<double> no_return_range_m;
  std::optional<double> cut_after_s;
  std::optional<RobotModel> robot;  // calibration for logs that carry none
  formats::RawSensors raw;
  std::optional<formats::BagTopics> topics;  // of a ROS bag

  [[nodiscard]] bool is_readable() const;  // as a sensor log
  [[nodiscard]] bool is_graph() const;
};

struct Catalog {
  std::vector<CatalogEntry> entries;
  [[nodiscard]] const CatalogEntry* find(std::string_view name) const;
};

// The catalog.toml of the source tree the program was built from; $CORRIDOR_BENCH_CATALOG
// overrides.
std::filesystem::path default_catalog_path();

// The Error lists every violation: unknown keys, missing keys, names given twice, bad checksums.
Result<Catalog> read_catalog(const std::filesystem::path& path = default_catalog_path());

struct LoadOptions {
  std::optional<formats::StampOrder> order;  // instead of the catalogue's (or kStamp for a file)
  // Load a catalogued log although its bytes are not those of the catalogue; noted in provenance.
  bool accept_other_checksum = false;
  // Leave stamps as the files have them: for those who copy files that lie beside the log.
  bool keep_lidar_clock = false;
};

struct LoadedDataset {
  SensorLog log;
  std::optional<std::vector<formats::Relation>> relations;
  std::optional<std::filesystem::path> world_file;  // LOG.truth.toml of a simulated log
  std::string name;    // the catalogue's, or the log's file name without its log suffix
  std::string sha256;  // of the log file
  // Of all that decides what is run and scored: the log, what lies beside it (.robot.toml .tum
  // .relations .truth.toml), the order and the catalogue's calibration. `sha256` for a log alone.
  std::string digest;
  // lidar.time_offset_s as it was stated: scans, and what carries their stamps, were moved by it.
  double lidar_time_offset_s = 0;
};

// `name_or_path` is a catalogued name or the path of a log file; truth is LOG.tum or LOG.relations
// beside it. A name wins over a file of the same name.
Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const LoadOptions& options = {});
Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const Catalog& catalog, const LoadOptions& options = {});

// Where a log lies and how the catalogue says to read it.
struct LogSource {
  std::string name;
  std::filesystem::path path;
  formats::ReadLogOptions options;
  std::vector<std::string> notes;  // what was let through
};
Result<LogSource> find_log(std::string_view name_or_path, const DataDirs& dirs,
                           const Catalog& catalog, const LoadOptions& options = {});

// The same for a pose graph: a catalogued name, whose file must have its checksum, or a path.
Result<formats::PoseGraph> load_graph(std::string_view name_or_path, const DataDirs& dirs,
                                      const Catalog& catalog);

struct DatasetRow {
  std::string name;
  std::string title;
  bool is_found = false;
  bool is_readable = false;
  std::filesystem::path path;  // of the log, where it was found
  std::string format;
  TruthKind truth = TruthKind::kNone;
  std::string licence;
  std::string source;
  bool is_fetchable = false;
  std::string not_fetchable;  // why
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

// Compares every file of an entry with the catalogue. An Error for an unknown name.
Result<std::vector<VerifiedFile>> verify_dataset(const Catalog& catalog, std::string_view name,
                                                 const DataDirs& dirs);

}  // namespace corridor::catalog
