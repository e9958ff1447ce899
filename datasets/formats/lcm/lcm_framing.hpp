// The chain of events of an LCM event log, checked byte by byte before any message is decoded:
//   u32 sync 0xEDA1DA01, u64 number, i64 utime_us, u32 channel length, u32 data length, channel,
//   data; all big endian.
// An Error names the byte: a broken sync word, a number that does not follow the one before (an
// event is missing), a channel that is no name, a length beyond its cap or the end of the file.
// liblcm's reader searches for the next sync word instead and says nothing. Internal to this
// folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::formats {

struct LcmEvent {
  std::int64_t utime_us = 0;  // when the logger received it, on the logger's clock
  std::string_view channel;
  std::string_view data;
  std::size_t begin = 0;       // byte of the event in the decompressed file
  std::size_t data_begin = 0;  // byte of its data
};

// True if the bytes begin as an LCM event log does.
bool begins_with_lcm_sync(std::string_view bytes);

// The events look into `bytes`, the decompressed file.
Result<std::vector<LcmEvent>> split_lcm_events(std::string_view bytes, const std::string& file);

}  // namespace corridor::formats
