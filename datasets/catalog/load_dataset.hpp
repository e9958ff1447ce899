// Loading a data set by its name, any log by its path, with its truth.
// It decides nothing about scoring.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::catalog {

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

// `name_or_path` is a catalogued name or the path of a log file. By name, the files that the
// catalogue lists are read and no others; by path, whatever lies beside the log
// (formats::kSidecarSuffixes). A name wins over a file of the same name.
Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const LoadOptions& options = {});
Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const Catalog& catalog, const LoadOptions& options = {});

// Where a log lies and how the catalogue says to read it.
struct LogSource {
  std::string name;
  std::filesystem::path path;
  formats::ReadLogOptions options;
  std::vector<std::string> notes;  // what was left
  // One line per file that is not the catalogue's; empty but with accept_other_checksum.
  std::vector<std::string> other_checksums;
};
Result<LogSource> find_log(std::string_view name_or_path, const DataDirs& dirs,
                           const Catalog& catalog, const LoadOptions& options = {});

}  // namespace corridor::catalog
