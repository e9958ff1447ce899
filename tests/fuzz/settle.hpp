// What becomes of a log's events behind its parser, as read_log does it: order, calibration, ticks,
// defects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/formats/parsed_log.hpp"

namespace corridor::fuzz {

// Both ways of settling the order are tried; returns the logs that are fit. `sidecar_toml` is
// LOG.robot.toml.
std::vector<SensorLog> settle(const formats::ParsedLog& parsed,
                              const std::optional<std::string>& sidecar_toml = std::nullopt);

// `again`: a fit log written and parsed once more. It may be refused, as `convert` refuses what a
// format cannot hold; but what is read has as many scans and no fewer wheel samples, and as many
// readings in all where the format holds every sensor (`holds_all`).
void expect_same_readings(const SensorLog& log, const Result<formats::ParsedLog>& again,
                          bool holds_all = true);

}  // namespace corridor::fuzz
