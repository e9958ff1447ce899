#include "datasets/catalog/fetch.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "datasets/catalog/checksum.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"

namespace corridor::catalog {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartSuffix = ".part";

fs::path part_of(const fs::path& target) {
  fs::path part = target;
  part += kPartSuffix;
  return part;
}

// What lies at `target` already; nullopt: nothing.
std::optional<FetchedFile> found_at(const fs::path& target, const DataFile& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(target, error);
  if (!fs::exists(status)) return std::nullopt;
  if (!is_file(target)) {
    return FetchedFile{target, FetchStatus::kFailed, "something that is no file lies there"};
  }
  const auto sum = checksum_of(target, file);
  if (!sum) return FetchedFile{target, FetchStatus::kFailed, sum.error().to_line()};
  if (*sum == file.sha256) return FetchedFile{target, FetchStatus::kPresent, ""};
  return FetchedFile{
      target, FetchStatus::kFailed,
      fmt::format("a file of SHA-256 {} lies there; expected {}, or nothing: move it "
                  "away to fetch the data set",
                  *sum, file.sha256)};
}

// Downloads until `part` has the checksum. A part of an earlier attempt may be that of another
// file: then once more from the start.
Result<void> fill(PartFile& part, const DataFile& file, const DownloadOptions& options) {
  while (true) {
    const bool is_resumed = part.size_bytes() > 0;
    if (auto done = download(file.url, part, options); !done) return done;
    const auto sum = checksum_of(part.path(), file);
    if (!sum) return tl::make_unexpected(sum.error());
    if (*sum == file.sha256) return {};
    if (auto cleared = part.clear(); !cleared) return cleared;
    if (!is_resumed) {
      return fail(ErrorCode::kInvalid, fmt::format("SHA-256 is {}: what came is removed", *sum),
                  file.url, file.sha256);
    }
  }
}

// Onto `target`, packed as its name says.
Result<void> store(PartFile& part, const DataFile& file, const fs::path& target) {
  if (!file.is_sum_of_content) return part.rename_to(target);
  const auto content = formats::read_file_bytes(part.path());
  if (!content) return tl::make_unexpected(content.error());
  const auto stored = target.extension() == ".gz" ? formats::gzip(*content) : content;
  if (!stored) return tl::make_unexpected(stored.error());
  if (auto written = formats::write_file_atomically(target, *stored); !written) return written;
  part.remove();
  return {};
}

FetchedFile failed(const fs::path& target, std::string message) {
  return {target, FetchStatus::kFailed, std::move(message)};
}

FetchedFile fetch_file(const DataFile& file, const fs::path& target,
                       const DownloadOptions& options) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) {
    return failed(target, fmt::format("{}: the folder cannot be made: {}",
                                      target.parent_path().string(), error.message()));
  }
  auto part = PartFile::open(part_of(target));
  if (!part) return failed(target, part.error().to_line());
  if (const auto filled = fill(*part, file, options); !filled) {
    std::string message = filled.error().to_line();
    if (part->size_bytes() == 0) {
      part->remove();
    } else {
      message += fmt::format("; {} bytes are kept in {}: fetching again goes on from there",
                             part->size_bytes(), part->path().string());
    }
    return failed(target, std::move(message));
  }
  if (const auto stored = store(*part, file, target); !stored) {
    return failed(target, stored.error().to_line());
  }
  return {target, FetchStatus::kFetched, ""};
}

}  // namespace

std::string_view to_text(FetchStatus status) {
  switch (status) {
    case FetchStatus::kFetched:
      return "fetched";
    case FetchStatus::kPresent:
      return "is here";
    case FetchStatus::kNotFetchable:
      return "not fetchable";
    case FetchStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

std::vector<FetchedFile> fetch_dataset(const CatalogEntry& entry, const fs::path& folder,
                                       const DownloadOptions& options) {
  std::vector<FetchedFile> files;
  for (const DataFile& file : entry.files) {
    const fs::path target = folder / file.path;
    if (auto found = found_at(target, file)) {
      files.push_back(std::move(*found));
    } else if (file.url.empty()) {
      files.push_back({target, FetchStatus::kNotFetchable, entry.not_fetchable});
    } else {
      files.push_back(fetch_file(file, target, options));
    }
  }
  return files;
}

}  // namespace corridor::catalog
