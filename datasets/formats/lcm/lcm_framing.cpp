#include "datasets/formats/lcm/lcm_framing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "datasets/formats/byte_walker.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::string_view kSyncBytes = "\xED\xA1\xDA\x01";
constexpr std::uint32_t kMaxChannelLength = 63;    // LCM's own limit
constexpr std::uint32_t kMaxDataBytes = 1U << 24;  // LCM sends no more in one message by default
// The year 2096: far from what int64 nanoseconds hold, so that sums of stamps do not overflow.
constexpr std::int64_t kMaxUtime_us = 4'000'000'000'000'000;

bool is_channel_name(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

std::uint32_t take_length(ByteWalker& walker, std::uint32_t min, std::uint32_t max,
                          std::string_view what) {
  const std::size_t at = walker.offset();
  const auto length = walker.take<std::uint32_t>(what);
  if (walker.has_failed()) return 0;
  if (length >= min && length <= max) return length;
  walker.refuse(at, fmt::format("{} is {}", what, length), fmt::format("{} to {}", min, max));
  return 0;
}

LcmEvent take_event(ByteWalker& walker, std::optional<std::uint64_t>& last_number) {
  LcmEvent event;
  event.begin = walker.offset();
  if (walker.take<std::uint32_t>("an event's sync word") != kSync) {
    walker.refuse(event.begin, "no event begins here", "LCM's sync word ED A1 DA 01");
  }
  const std::size_t number_begin = walker.offset();
  const auto number = walker.take<std::uint64_t>("an event's number");
  if (last_number && number != *last_number + 1) {
    walker.refuse(number_begin, fmt::format("event number {}", number),
                  fmt::format("{}: the events between are missing", *last_number + 1));
  }
  last_number = number;
  const std::size_t utime_begin = walker.offset();
  event.utime_us = walker.take<std::int64_t>("an event's time");
  if (event.utime_us < 0 || event.utime_us > kMaxUtime_us) {
    walker.refuse(utime_begin, fmt::format("event time of {} us", event.utime_us),
                  fmt::format("0 to {}", kMaxUtime_us));
  }
  const std::uint32_t channel_length =
      take_length(walker, 1, kMaxChannelLength, "an event's channel length");
  const std::uint32_t data_length = take_length(walker, 0, kMaxDataBytes, "an event's data length");
  const std::size_t channel_begin = walker.offset();
  event.channel = walker.take_bytes(channel_length, "an event's channel");
  if (!is_channel_name(event.channel)) {
    walker.refuse(channel_begin, fmt::format("channel {}", quote(event.channel)),
                  "printable characters without blanks");
  }
  event.data_begin = walker.offset();
  event.data = walker.take_bytes(data_length, "an event's data");
  return event;
}

}  // namespace

bool begins_with_lcm_sync(std::string_view bytes) { return bytes.starts_with(kSyncBytes); }

Result<std::vector<LcmEvent>> split_lcm_events(std::string_view bytes, const std::string& file) {
  std::vector<LcmEvent> events;
  std::optional<std::uint64_t> last_number;
  ByteWalker walker(bytes, file);
  while (!walker.at_end()) {
    const LcmEvent event = take_event(walker, last_number);
    if (walker.has_failed()) return tl::make_unexpected(walker.error());
    events.push_back(event);
  }
  return events;
}

}  // namespace corridor::formats
