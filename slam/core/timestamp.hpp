// Time as the suite keeps it: integer nanoseconds since the log's own epoch.
// It does not know time zones, leap seconds or the machine's clock.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace corridor {

struct Timestamp {
  std::int64_t nanoseconds = 0;

  auto operator<=>(const Timestamp&) const = default;
};

inline constexpr double kNanosecondsPerSecond = 1e9;

// Rounds to the nearest nanosecond. `seconds` must be finite and |seconds| < 9.2e9.
inline Timestamp timestamp_from_seconds(double seconds) {
  const double whole_s = std::floor(seconds);
  const double fraction_s = seconds - whole_s;
  return {static_cast<std::int64_t>(whole_s) * 1'000'000'000 +
          static_cast<std::int64_t>(std::llround(fraction_s * kNanosecondsPerSecond))};
}

// Exact to about 0.1 us for stamps near today's Unix time; keep integers where exactness matters.
inline double to_seconds(Timestamp stamp) {
  return static_cast<double>(stamp.nanoseconds) / kNanosecondsPerSecond;
}

// later - earlier [s], negative when `later` is before `earlier`.
inline double seconds_between(Timestamp earlier, Timestamp later) {
  return static_cast<double>(later.nanoseconds - earlier.nanoseconds) / kNanosecondsPerSecond;
}

inline Timestamp add_seconds(Timestamp stamp, double seconds) {
  return {stamp.nanoseconds +
          static_cast<std::int64_t>(std::llround(seconds * kNanosecondsPerSecond))};
}

}  // namespace corridor
