// The order of events in a log: checked against the stamps, or kept as in the file with the stamps
// made to fit it. It never changes the order of events.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// Rows of one archive tick no finer than this; the smallest step isotonic regression leaves.
inline constexpr std::int64_t kMinStep_ns = 1'000;

// Least-squares fit x of `stamps_ns` with x[i+1] - x[i] >= min_step_ns, by pool adjacent violators
// on stamps_ns[i] - i * min_step_ns; block means are rounded to whole nanoseconds. Sequences that
// fit already are returned unchanged.
std::vector<std::int64_t> isotonic_stamps(const std::vector<std::int64_t>& stamps_ns,
                                          std::int64_t min_step_ns);

// An Error that names the first row whose stamp steps back or repeats within a sensor.
Result<void> check_stamp_order(const ParsedLog& log, const std::string& file);

// Makes the stamps of the rows strictly increasing; a row is one event, or several of different
// sensors that follow each other with the same stamp. Returns the number of rows that changed.
std::size_t make_stamps_increase(std::vector<SensorEvent>& events);

}  // namespace corridor::formats
