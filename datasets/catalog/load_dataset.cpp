// What every command that takes a data set goes through.
#include "datasets/catalog/load_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "datasets/catalog/catalogued_files.hpp"
#include "datasets/catalog/checksum.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/lidar_clock.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "slam/core/nearest_names.hpp"

namespace corridor::catalog {
namespace {

std::vector<std::string> names_of(const Catalog& catalog) {
  std::vector<std::string> names;
  for (const CatalogEntry& entry : catalog.entries) names.push_back(entry.name);
  return names;
}

// "" for the defaults of a log that is read by its path.
std::string options_text(const formats::ReadLogOptions& options) {
  std::string text;
  if (options.order != formats::StampOrder::kStamp) text += "order file\n";
  if (options.no_return_range_m)
    text += fmt::format("no return {} m\n", *options.no_return_range_m);
  if (options.robot) text += formats::robot_to_toml(*options.robot);
  return text;
}

Result<std::string> digest_of(const std::filesystem::path& log, const std::string& log_sha256,
                              const formats::ReadLogOptions& options) {
  std::string text = options_text(options);
  for (const std::string_view suffix : formats::kSidecarSuffixes) {
    const auto path = formats::find_sidecar(log, suffix, options);
    if (!path) return tl::make_unexpected(path.error());
    if (!*path) continue;
    const auto sha256 = sha256_of_file(**path);
    if (!sha256) return sha256;
    text += fmt::format("{} {}\n", suffix, *sha256);
  }
  if (text.empty()) return log_sha256;
  return to_hex(sha256_of(fmt::format("log {}\n{}", log_sha256, text)));
}

// Of the log file: `known`, where the catalogue has compared it already.
Result<LoadedDataset> load_file(const LogSource& source, const std::optional<std::string>& known) {
  const std::filesystem::path& log = source.path;
  LoadedDataset loaded;
  Result<std::string> sha256 = known ? Result<std::string>(*known) : sha256_of_file(log);
  if (!sha256) return tl::make_unexpected(sha256.error());
  loaded.sha256 = std::move(*sha256);
  auto digest = digest_of(log, loaded.sha256, source.options);
  if (!digest) return tl::make_unexpected(digest.error());
  loaded.digest = std::move(*digest);
  auto read = formats::read_log(log, source.options);
  if (!read) return tl::make_unexpected(read.error());
  loaded.log = std::move(*read);
  loaded.name = loaded.log.provenance.name = source.name;
  auto& notes = loaded.log.provenance.notes;
  for (const std::string& line : source.other_checksums) {
    notes.push_back(line + ", accepted on request");
  }
  notes.insert(notes.end(), source.notes.begin(), source.notes.end());
  auto world_file = formats::find_sidecar(log, ".truth.toml", source.options);
  if (!world_file) return tl::make_unexpected(world_file.error());
  loaded.world_file = std::move(*world_file);
  const auto relations_file = formats::find_sidecar(log, ".relations", source.options);
  if (!relations_file) return tl::make_unexpected(relations_file.error());
  if (!*relations_file) return loaded;
  auto relations = formats::read_relations(**relations_file);
  if (!relations) return tl::make_unexpected(relations.error());
  loaded.relations = std::move(*relations);
  return loaded;
}

// Only what the catalogue lists is taken along: of the rest it has no checksum.
void take_listed_sidecars(const CatalogEntry& entry, LogSource& source) {
  const std::vector<std::string> listed = entry.sidecars();
  source.options.only_sidecars = listed;
  for (const std::string_view suffix : formats::kSidecarSuffixes) {
    const std::filesystem::path path = formats::sidecar_of(source.path, suffix);
    const bool is_listed = std::find(listed.begin(), listed.end(), suffix) != listed.end();
    if (is_listed || !is_file(path)) continue;
    source.notes.push_back(
        fmt::format("{} lies beside the log and is not used: data set {} does "
                    "not list it",
                    path.filename().string(), entry.name));
  }
}

// What only the log itself can tell: the catalogue's word for it must be true.
Result<void> check_entry(const CatalogEntry& entry, const SensorLog& log) {
  if (log.provenance.format != entry.format) {
    return fail(ErrorCode::kInvalid,
                fmt::format("data set {}: the log is a {} log", entry.name, log.provenance.format),
                log.provenance.source, "format = \"" + entry.format + "\", as catalogued");
  }
  if (entry.truth == TruthKind::kReference && !log.truth) {
    return fail(ErrorCode::kInvalid,
                fmt::format("data set {}: the log holds no poses of its own", entry.name),
                log.provenance.source, "truth = \"reference\", as catalogued");
  }
  return {};
}

Result<LogSource> find_entry(const CatalogEntry& entry, const DataDirs& dirs,
                             const LoadOptions& options) {
  if (entry.is_graph()) {
    return fail(ErrorCode::kUnsupported, fmt::format("data set {} is a pose graph", entry.name),
                "catalogue", "a log: carmen, rawlog, lcm, ticks or rosbag");
  }
  const auto folder = folder_of(entry, dirs);
  if (!folder) return tl::make_unexpected(folder.error());
  auto other_checksums = check_files(entry, *folder, options.accept_other_checksum);
  if (!other_checksums) return tl::make_unexpected(other_checksums.error());
  LogSource source{
      entry.name, *folder / entry.files.front().path, {}, {}, std::move(*other_checksums)};
  const bool is_other = !source.other_checksums.empty() && entry.order_of_other_files.has_value();
  formats::ReadLogOptions& read = source.options;
  read.order = options.order.value_or(is_other ? *entry.order_of_other_files : entry.order);
  read.no_return_range_m = entry.no_return_range_m;
  read.robot = entry.robot;
  read.robot_keys = entry.robot_keys;
  read.raw = entry.raw;
  read.cut_after_s = entry.cut_after_s;
  read.topics = entry.topics;
  read.takes_reference = entry.truth == TruthKind::kReference;
  take_listed_sidecars(entry, source);
  return source;
}

Result<LogSource> find_path(const std::filesystem::path& path, const Catalog& catalog,
                            const LoadOptions& options) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !is_file(path)) {
    return fail(ErrorCode::kNotFound, "this is no regular file", path.string(),
                "a log file, or the name of a data set");
  }
  if (!is_file(path)) {
    return fail(ErrorCode::kNotFound,
                fmt::format("'{}' is neither a data set nor a log file", path.string()), "",
                fmt::format("a file, or one of `data list`; the nearest names: {}",
                            fmt::join(nearest_names(path.string(), names_of(catalog)), ", ")));
  }
  LogSource source{formats::sidecar_of(path, "").filename().string(), path, {}, {}, {}};
  source.options.order = options.order.value_or(formats::StampOrder::kStamp);
  return source;
}

}  // namespace

Result<LogSource> find_log(std::string_view name_or_path, const DataDirs& dirs,
                           const Catalog& catalog, const LoadOptions& options) {
  const CatalogEntry* entry = catalog.find(name_or_path);
  return entry != nullptr ? find_entry(*entry, dirs, options)
                          : find_path(name_or_path, catalog, options);
}

Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const Catalog& catalog, const LoadOptions& options) {
  const auto source = find_log(name_or_path, dirs, catalog, options);
  if (!source) return tl::make_unexpected(source.error());
  // A log that may be packed in another way is known by its content.
  std::optional<std::string> known;
  const CatalogEntry* entry = catalog.find(name_or_path);
  if (entry != nullptr && entry->files.front().is_sum_of_content) {
    auto sum = checksum_of(source->path, entry->files.front());
    if (!sum) return tl::make_unexpected(sum.error());
    known = std::move(*sum);
  }
  auto loaded = load_file(*source, known);
  if (loaded && entry != nullptr) {
    if (const auto good = check_entry(*entry, loaded->log); !good) {
      return tl::make_unexpected(good.error());
    }
  }
  if (!loaded || options.keep_lidar_clock) return loaded;
  loaded->lidar_time_offset_s = formats::move_onto_wheel_clock(
      loaded->log, loaded->relations ? &*loaded->relations : nullptr);
  return loaded;
}

Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const LoadOptions& options) {
  const auto catalog = known_datasets(dirs);
  if (!catalog) return tl::make_unexpected(catalog.error());
  return load_dataset(name_or_path, dirs, *catalog, options);
}

}  // namespace corridor::catalog
