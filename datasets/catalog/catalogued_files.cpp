#include "datasets/catalog/catalogued_files.hpp"

#include <fmt/format.h>

#include "datasets/catalog/checksum.hpp"
#include "datasets/catalog/find_folder.hpp"

namespace corridor::catalog {
namespace {

std::string folders_text(const DataDirs& dirs) {
  std::vector<std::string> names;
  for (const auto& folder : dirs.folders) names.push_back(folder.string());
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Result<std::filesystem::path> folder_of(const CatalogEntry& entry, const DataDirs& dirs) {
  if (const auto folder = find_folder(entry, dirs)) return *folder;
  const std::string way = entry.not_fetchable.empty()
                              ? fmt::format("`corridor-bench data fetch {}` gets it", entry.name)
                              : entry.not_fetchable + "; source: " + entry.source;
  return fail(
      ErrorCode::kNotFound,
      fmt::format("data set {}: {} not found", entry.name, entry.files.front().path.string()),
      entry.folder ? entry.folder->string() : folders_text(dirs),
      (entry.folder ? "the file in this folder; " : "the file in one of these folders; ") + way);
}

Result<std::vector<std::string>> check_files(const CatalogEntry& entry,
                                             const std::filesystem::path& folder,
                                             bool accept_other_checksum) {
  std::vector<std::string> other_checksums;
  for (const DataFile& file : entry.files) {
    const std::filesystem::path path = folder / file.path;
    if (!is_file(path)) {
      return fail(ErrorCode::kNotFound,
                  fmt::format("data set {}: {} not found", entry.name, file.path.string()),
                  folder.string(), "all files of the data set in one folder");
    }
    const auto sha256 = checksum_of(path, file);
    if (!sha256) return tl::make_unexpected(sha256.error());
    if (*sha256 == file.sha256) continue;
    if (!accept_other_checksum) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("data set {}: SHA-256 is {}", entry.name, *sha256), path.string(),
                  file.sha256);
    }
    other_checksums.push_back(
        fmt::format("{}: SHA-256 {} is not the catalogue's", path.string(), *sha256));
  }
  return other_checksums;
}

}  // namespace corridor::catalog
