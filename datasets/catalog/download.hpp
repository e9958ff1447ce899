// Bytes of a public address into a file: the one door to libcurl.
// It trusts nothing it gets: whether the bytes are the right ones is fetch.hpp's to say.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "datasets/catalog/part_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "slam/core/result.hpp"

namespace corridor::catalog {

struct DownloadOptions {
  double connect_timeout_s = 30;
  double stall_timeout_s = 30;  // this long without a byte ends an attempt
  // After a cut connection the next attempt goes on behind what has arrived; an attempt that
  // brought nothing is the last.
  int max_attempts = 4;
  int max_redirects = 8;
  std::uint64_t max_bytes = formats::kMaxFileBytes;
  // Called often with what has arrived, and with the whole if the server said it.
  std::function<void(std::uint64_t num_bytes, std::optional<std::uint64_t> num_bytes_total)>
      on_progress;
};

// Appends to `part` what is missing of `url`. A server that ignores the request for the rest sends
// the whole, which then takes the part's place. Redirects are followed to addresses that
// check_public_url() accepts, never from https to http. TLS certificates are checked.
// On an Error `part` holds what has arrived so far.
Result<void> download(const std::string& url, PartFile& part, const DownloadOptions& options = {});

}  // namespace corridor::catalog
