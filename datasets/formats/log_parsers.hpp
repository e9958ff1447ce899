// Which parser reads a log, and what it needs from beside the log. Internal to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "datasets/formats/log_io.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// LOG.robot.toml, where it is taken along.
struct Sidecar {
  std::string file;
  std::string text;
};
Result<std::optional<Sidecar>> read_sidecar(const std::filesystem::path& log,
                                            const ReadLogOptions& options);

// By the suffix, which the content must fit; a .log that begins as an LCM event log does is one.
Result<ParsedLog> parse_log(const std::filesystem::path& path,
                            const std::optional<Sidecar>& sidecar, const ReadLogOptions& options);

}  // namespace corridor::formats
