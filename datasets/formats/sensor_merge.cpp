#include "datasets/formats/sensor_merge.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace corridor::formats {
namespace {

constexpr std::size_t kNumSensors = std::variant_size_v<SensorEvent>;

// Indices of each sensor's events, in the order of the file.
std::array<std::vector<std::size_t>, kNumSensors> by_sensor(
    const std::vector<SensorEvent>& events) {
  std::array<std::vector<std::size_t>, kNumSensors> indices;
  for (std::size_t i = 0; i < events.size(); ++i) indices[events[i].index()].push_back(i);
  return indices;
}

}  // namespace

std::size_t merge_sensors(ParsedLog& log) {
  const auto indices = by_sensor(log.events);
  std::array<std::size_t, kNumSensors> num_taken{};
  std::vector<SensorEvent> events;
  std::vector<std::uint64_t> origins;
  std::size_t num_moved = 0;
  std::uint64_t last_origin = 0;
  while (events.size() < log.events.size()) {
    std::optional<std::size_t> next;
    for (std::size_t sensor = 0; sensor < kNumSensors; ++sensor) {
      if (num_taken[sensor] == indices[sensor].size()) continue;
      const std::size_t candidate = indices[sensor][num_taken[sensor]];
      const auto key = [&log](std::size_t i) {
        return std::pair(stamp_of(log.events[i]), log.origins[i]);
      };
      if (!next || key(candidate) < key(*next)) next = candidate;
    }
    if (log.origins[*next] < last_origin) ++num_moved;
    last_origin = std::max(last_origin, log.origins[*next]);
    ++num_taken[log.events[*next].index()];
    events.push_back(std::move(log.events[*next]));
    origins.push_back(log.origins[*next]);
  }
  log.events = std::move(events);
  log.origins = std::move(origins);
  return num_moved;
}

}  // namespace corridor::formats
