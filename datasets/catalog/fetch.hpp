// Gets the files of a data set from where the catalogue says the public finds them.
// Nothing reaches its place in the data folder before its checksum was compared.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "datasets/catalog/download.hpp"

namespace corridor::catalog {

enum class FetchStatus {
  kFetched,
  kPresent,       // was there, with the catalogue's checksum
  kNotFetchable,  // the catalogue has no address, and says why
  kFailed,
};
std::string_view to_text(FetchStatus status);

struct FetchedFile {
  std::filesystem::path path;  // where it lies or would lie
  FetchStatus status = FetchStatus::kFailed;
  std::string message;  // one line: why it is not there
};

// Every file of `entry` into `folder`, which is made if need be. Bytes arrive in FILE.part and go
// on there after a cut. A file whose checksum differs is removed; one that lies in the way with
// another checksum is left as it is, which is a failure. Files whose sum is that of their content
// are packed or unpacked as their name says.
std::vector<FetchedFile> fetch_dataset(const CatalogEntry& entry,
                                       const std::filesystem::path& folder,
                                       const DownloadOptions& options = {});

}  // namespace corridor::catalog
