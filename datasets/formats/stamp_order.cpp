#include "datasets/formats/stamp_order.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

#include "slam/core/same_reading.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumSensors = std::variant_size_v<SensorEvent>;

// Consecutive values that share one mean. Sums of offsets from the first stamp stay exact in 128
// bits.
__extension__ using Wide = __int128;

struct Block {
  Wide sum = 0;
  std::int64_t count = 0;

  // mean(this) > mean(later), without division.
  [[nodiscard]] bool exceeds(const Block& later) const {
    return sum * later.count > later.sum * count;
  }
  void merge(const Block& later) {
    sum += later.sum;
    count += later.count;
  }
  [[nodiscard]] std::int64_t rounded_mean() const {
    const Wide doubled = 2 * sum + count;  // floor(mean + 1/2)
    const Wide divisor = 2 * static_cast<Wide>(count);
    const Wide quotient = doubled / divisor;
    const bool rounds_down = doubled % divisor < 0;
    return static_cast<std::int64_t>(rounds_down ? quotient - 1 : quotient);
  }
};

// The first event of each row, in order.
std::vector<std::size_t> row_begins(const std::vector<SensorEvent>& events) {
  std::vector<std::size_t> begins;
  std::array<bool, kNumSensors> is_in_row{};
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::size_t sensor = events[i].index();
    const bool same_stamp = i > 0 && stamp_of(events[i]) == stamp_of(events[i - 1]);
    if (!same_stamp || is_in_row[sensor]) {
      begins.push_back(i);
      is_in_row.fill(false);
    }
    is_in_row[sensor] = true;
  }
  return begins;
}

void set_stamp(SensorEvent& event, Timestamp stamp) {
  std::visit([stamp](auto& reading) { reading.stamp = stamp; }, event);
}

}  // namespace

std::vector<std::int64_t> isotonic_stamps(const std::vector<std::int64_t>& stamps_ns,
                                          std::int64_t min_step_ns) {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    blocks.push_back({static_cast<Wide>(stamps_ns[i]) - static_cast<Wide>(index) * min_step_ns, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].exceeds(blocks.back())) {
      blocks[blocks.size() - 2].merge(blocks.back());
      blocks.pop_back();
    }
  }
  std::vector<std::int64_t> fitted;
  fitted.reserve(stamps_ns.size());
  for (const Block& block : blocks) {
    const std::int64_t mean_ns = block.rounded_mean();
    for (std::int64_t i = 0; i < block.count; ++i) {
      fitted.push_back(mean_ns + static_cast<std::int64_t>(fitted.size()) * min_step_ns);
    }
  }
  return fitted;
}

Result<void> check_stamp_order(const ParsedLog& log, const std::string& file) {
  std::array<std::optional<std::size_t>, kNumSensors> last_of_sensor;
  std::optional<Timestamp> last;
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    const Timestamp stamp = stamp_of(log.events[i]);
    auto& last_here = last_of_sensor[log.events[i].index()];
    const std::string where = fmt::format("{}: {} {}", file, log.origin_unit, log.origins[i]);
    if (last && stamp < *last) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("stamp steps back by {:.6f} s", seconds_between(stamp, *last)), where,
                  "stamps in order (a catalogue entry with order = \"file\" keeps the rows')");
    }
    if (last_here && stamp == stamp_of(log.events[*last_here])) {
      const std::string_view other = difference_of(log.events[*last_here], log.events[i]);
      return fail(ErrorCode::kInvalid,
                  fmt::format("stamp repeats that of the sensor's last reading{}{}",
                              other.empty() ? "" : ", which has ", other),
                  where, "a later one (a catalogue entry with order = \"file\" keeps the rows')");
    }
    last = stamp;
    last_here = i;
  }
  return {};
}

std::size_t make_stamps_increase(std::vector<SensorEvent>& events) {
  std::vector<std::size_t> begins = row_begins(events);
  std::vector<std::int64_t> stamps_ns;
  stamps_ns.reserve(begins.size());
  for (const std::size_t begin : begins) stamps_ns.push_back(stamp_of(events[begin]).nanoseconds);
  const std::vector<std::int64_t> fitted_ns = isotonic_stamps(stamps_ns, kMinStep_ns);
  begins.push_back(events.size());
  std::size_t num_changed = 0;
  for (std::size_t row = 0; row < fitted_ns.size(); ++row) {
    if (fitted_ns[row] == stamps_ns[row]) continue;
    ++num_changed;
    for (std::size_t i = begins[row]; i < begins[row + 1]; ++i) {
      set_stamp(events[i], Timestamp{fitted_ns[row]});
    }
  }
  return num_changed;
}

}  // namespace corridor::formats
