#include "datasets/catalog/catalog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "datasets/catalog/checksum.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "slam/core/nearest_names.hpp"

namespace corridor::catalog {
namespace {

// Where Debian's mrpt-common puts its recorded logs.
constexpr const char* kMrptDatasets = "/usr/share/mrpt/datasets";
constexpr const char* kCacheFolder = "corridor-bench";

// Empty variables count as unset, as the XDG base directory specification asks.
std::optional<std::filesystem::path> path_from_environment(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return std::filesystem::path(value);
}

}  // namespace

std::optional<std::filesystem::path> cache_folder() {
  if (const auto cache = path_from_environment("XDG_CACHE_HOME")) return *cache / kCacheFolder;
  if (const auto home = path_from_environment("HOME")) return *home / ".cache" / kCacheFolder;
  return std::nullopt;
}

DataDirs standard_data_dirs(const std::optional<std::filesystem::path>& data_dir) {
  DataDirs dirs;
  if (data_dir) dirs.folders.push_back(*data_dir);
  if (const auto folder = path_from_environment("CORRIDOR_BENCH_DATA")) {
    dirs.folders.push_back(*folder);
  }
  if (const auto folder = cache_folder()) dirs.folders.push_back(*folder);
  dirs.folders.emplace_back(kMrptDatasets);
  return dirs;
}

std::string_view to_text(TruthKind kind) {
  if (kind == TruthKind::kTum) return "tum";
  if (kind == TruthKind::kReference) return "reference";
  return kind == TruthKind::kRelations ? "relations" : "none";
}

std::string_view to_text(FileStatus status) {
  if (status == FileStatus::kMatches) return "matches";
  return status == FileStatus::kDiffers ? "differs" : "missing";
}

bool CatalogEntry::is_graph() const { return format == "g2o" || format == "toro"; }

std::vector<std::string> CatalogEntry::sidecars() const {
  std::vector<std::string> suffixes;
  for (const std::string_view suffix : formats::kSidecarSuffixes) {
    const auto path = formats::sidecar_of(files.front().path, suffix).lexically_normal();
    const auto is_it = [&](const DataFile& file) { return file.path.lexically_normal() == path; };
    if (std::any_of(files.begin() + 1, files.end(), is_it)) suffixes.emplace_back(suffix);
  }
  return suffixes;
}

const CatalogEntry* Catalog::find(std::string_view name) const {
  for (const CatalogEntry& entry : entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

std::filesystem::path main_catalog_path() {
  return path_from_environment("CORRIDOR_BENCH_CATALOG").value_or(CORRIDOR_CATALOG_FILE);
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::optional<std::filesystem::path> find_folder(const CatalogEntry& entry, const DataDirs& dirs) {
  const auto has_it = [&](const std::filesystem::path& folder) {
    return is_file(folder / entry.files.front().path);
  };
  if (entry.folder) return has_it(*entry.folder) ? entry.folder : std::nullopt;
  const auto found = std::find_if(dirs.folders.begin(), dirs.folders.end(), has_it);
  return found == dirs.folders.end() ? std::nullopt : std::optional(*found);
}

std::vector<DatasetRow> list_datasets(const Catalog& catalog, const DataDirs& dirs) {
  std::vector<DatasetRow> rows;
  for (const CatalogEntry& entry : catalog.entries) {
    const auto folder = find_folder(entry, dirs);
    const auto path = folder ? *folder / entry.files.front().path : std::filesystem::path();
    std::vector<std::filesystem::path> missing;
    for (const DataFile& file : entry.files) {
      if (folder && !is_file(*folder / file.path)) missing.push_back(file.path);
    }
    const bool is_found = folder.has_value() && missing.empty();
    rows.push_back({entry.name, entry.title, is_found, !entry.is_graph(), path, std::move(missing),
                    entry.format, entry.truth, entry.licence, entry.source,
                    entry.not_fetchable.empty(), entry.not_fetchable, entry.catalog_file,
                    entry.folder.has_value()});
  }
  return rows;
}

Error unknown_dataset(const Catalog& catalog, std::string_view name) {
  std::vector<std::string> names;
  for (const CatalogEntry& entry : catalog.entries) names.push_back(entry.name);
  return {ErrorCode::kNotFound, fmt::format("no data set '{}' in the catalogue", name), "",
          fmt::format("a name of `data list`; the nearest: {}",
                      fmt::join(nearest_names(name, names), ", "))};
}

Result<std::vector<VerifiedFile>> verify_dataset(const Catalog& catalog, std::string_view name,
                                                 const DataDirs& dirs) {
  const CatalogEntry* entry = catalog.find(name);
  if (entry == nullptr) return tl::make_unexpected(unknown_dataset(catalog, name));
  const auto folder = find_folder(*entry, dirs);
  std::vector<DataFile> files = entry->files;
  for (const DataFile& file : entry->companions) {
    if (folder && is_file(*folder / file.path)) files.push_back(file);
  }
  std::vector<VerifiedFile> verified;
  for (const DataFile& file : files) {
    VerifiedFile row{file.path, FileStatus::kMissing, "", file.sha256};
    if (folder && is_file(*folder / file.path)) {
      auto sha256 = checksum_of(*folder / file.path, file);
      if (!sha256) return tl::make_unexpected(sha256.error());
      row.path = *folder / file.path;
      row.status = *sha256 == file.sha256 ? FileStatus::kMatches : FileStatus::kDiffers;
      row.sha256 = std::move(*sha256);
    }
    verified.push_back(std::move(row));
  }
  return verified;
}

}  // namespace corridor::catalog
