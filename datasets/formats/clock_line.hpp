// From a sensor's clock to the clock of the logger, where each reading was stamped by the first and
// received by the second. Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace corridor::formats {

struct ClockPair {
  std::int64_t stamp_us = 0;     // the sensor's clock
  std::int64_t received_us = 0;  // the logger's clock: later by the way through the computer
};

// received = stamp + offset + drift * (stamp - reference): the clocks' relation without the delays.
struct ClockLine {
  std::int64_t reference_us = 0;
  double offset_us = 0;
  double drift_ratio = 0;  // positive: the sensor's clock is slow

  [[nodiscard]] std::int64_t to_logger_us(std::int64_t stamp_us) const;
};

// Delays are never negative, so the relation lies below all pairs: the edge of their lower convex
// hull under the middle of the stamps [Moon1999, "Estimation and removal of clock skew from network
// delay measurements"]. It is late by the shortest delay, which one-way stamps cannot tell.
// Stamps must increase strictly; nullopt for fewer than two pairs.
std::optional<ClockLine> clock_line(const std::vector<ClockPair>& pairs);

}  // namespace corridor::formats
