// What becomes of a log's events behind its parser, as read_log does it: order, calibration, ticks,
// defects.
#pragma once

#include <optional>
#include <string>

#include "datasets/formats/parsed_log.hpp"

namespace corridor::fuzz {

// Both ways of settling the order are tried. `sidecar_toml` is LOG.robot.toml.
void settle(const formats::ParsedLog& parsed,
            const std::optional<std::string>& sidecar_toml = std::nullopt);

}  // namespace corridor::fuzz
