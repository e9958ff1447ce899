// A data set by name or by file, with its truth: what every command that takes one goes through.
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "datasets/catalog/catalog.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/robot_toml.hpp"

namespace corridor::catalog {
namespace {

std::string folders_text(const DataDirs& dirs) {
  std::vector<std::string> names;
  for (const auto& folder : dirs.folders) names.push_back(folder.string());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string names_text(const Catalog& catalog) {
  std::vector<std::string> names;
  for (const CatalogEntry& entry : catalog.entries) names.push_back(entry.name);
  return fmt::format("{}", fmt::join(names, " "));
}

// What may lie beside a log and is read with it.
constexpr std::array<std::string_view, 4> kSidecars = {".robot.toml", ".tum", ".relations",
                                                       ".truth.toml"};

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
  for (const std::string_view suffix : kSidecars) {
    const std::filesystem::path path = formats::sidecar_of(log, suffix);
    if (!is_file(path)) continue;
    const auto sha256 = sha256_of_file(path);
    if (!sha256) return sha256;
    text += fmt::format("{} {}\n", suffix, *sha256);
  }
  if (text.empty()) return log_sha256;
  return to_hex(sha256_of(fmt::format("log {}\n{}", log_sha256, text)));
}

Result<LoadedDataset> load_file(const std::filesystem::path& log,
                                const formats::ReadLogOptions& options) {
  LoadedDataset loaded;
  auto sha256 = sha256_of_file(log);
  if (!sha256) return tl::make_unexpected(sha256.error());
  loaded.sha256 = std::move(*sha256);
  auto digest = digest_of(log, loaded.sha256, options);
  if (!digest) return tl::make_unexpected(digest.error());
  loaded.digest = std::move(*digest);
  auto read = formats::read_log(log, options);
  if (!read) return tl::make_unexpected(read.error());
  loaded.log = std::move(*read);
  loaded.name = loaded.log.provenance.name;
  const auto relations_file = formats::sidecar_of(log, ".relations");
  if (is_file(relations_file)) {
    auto relations = formats::read_relations(relations_file);
    if (!relations) return tl::make_unexpected(relations.error());
    loaded.relations = std::move(*relations);
  }
  const auto world_file = formats::sidecar_of(log, ".truth.toml");
  if (is_file(world_file)) loaded.world_file = world_file;
  return loaded;
}

// Every file of the entry must be there and be the catalogue's; otherwise a result would carry the
// name of data it was not made from. Returns notes on what was let through.
Result<std::vector<std::string>> check_files(const CatalogEntry& entry,
                                             const std::filesystem::path& folder,
                                             bool accept_other_checksum) {
  std::vector<std::string> notes;
  for (const DataFile& file : entry.files) {
    const std::filesystem::path path = folder / file.path;
    if (!is_file(path)) {
      return fail(ErrorCode::kNotFound,
                  fmt::format("data set {}: {} not found", entry.name, file.path.string()),
                  folder.string(), "all files of the data set in one folder");
    }
    const auto sha256 = sha256_of_file(path);
    if (!sha256) return tl::make_unexpected(sha256.error());
    if (*sha256 == file.sha256) continue;
    if (!accept_other_checksum) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("data set {}: SHA-256 is {}", entry.name, *sha256), path.string(),
                  file.sha256);
    }
    notes.push_back(fmt::format("{}: SHA-256 {} is not the catalogue's, accepted on request",
                                path.string(), *sha256));
  }
  return notes;
}

Result<LoadedDataset> load_entry(const CatalogEntry& entry, const DataDirs& dirs,
                                 const LoadOptions& options) {
  if (!entry.is_readable()) {
    return fail(ErrorCode::kUnsupported,
                fmt::format("data set {}: format {} is not readable by this version", entry.name,
                            entry.format),
                "catalogue", "carmen, rawlog, lcm, ticks or rosbag");
  }
  const auto folder = find_folder(entry, dirs);
  if (!folder) {
    return fail(
        ErrorCode::kNotFound,
        fmt::format("data set {}: {} not found", entry.name, entry.files.front().path.string()),
        folders_text(dirs), "the file in one of these folders; source: " + entry.source);
  }
  auto notes = check_files(entry, *folder, options.accept_other_checksum);
  if (!notes) return tl::make_unexpected(notes.error());
  formats::ReadLogOptions read;
  read.order = options.order.value_or(entry.order);
  read.no_return_range_m = entry.no_return_range_m;
  read.robot = entry.robot;
  read.raw = entry.raw;
  read.cut_after_s = entry.cut_after_s;
  read.topics = entry.topics;
  auto loaded = load_file(*folder / entry.files.front().path, read);
  if (!loaded) return loaded;
  loaded->name = loaded->log.provenance.name = entry.name;
  auto& log_notes = loaded->log.provenance.notes;
  log_notes.insert(log_notes.end(), notes->begin(), notes->end());
  return loaded;
}

}  // namespace

Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const Catalog& catalog, const LoadOptions& options) {
  if (const CatalogEntry* entry = catalog.find(name_or_path)) {
    return load_entry(*entry, dirs, options);
  }
  const std::filesystem::path path(name_or_path);
  if (!is_file(path)) {
    return fail(ErrorCode::kNotFound,
                fmt::format("'{}' is neither a data set nor a log file", name_or_path), "",
                "a file, or one of: " + names_text(catalog));
  }
  formats::ReadLogOptions read;
  read.order = options.order.value_or(formats::StampOrder::kStamp);
  return load_file(path, read);
}

Result<LoadedDataset> load_dataset(std::string_view name_or_path, const DataDirs& dirs,
                                   const LoadOptions& options) {
  const auto catalog = read_catalog();
  if (!catalog) return tl::make_unexpected(catalog.error());
  return load_dataset(name_or_path, dirs, *catalog, options);
}

}  // namespace corridor::catalog
