// What a ROS 1 bag's index records and chunk infos state, held against what the chunks hold.
// Internal to this folder; bag_framing knows where such records may stand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "datasets/formats/bag/bag_records.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

inline constexpr std::size_t kIndexEntryBytes = 12;     // u32 s, u32 ns, u32 offset in the chunk
inline constexpr std::size_t kChunkInfoEntryBytes = 8;  // u32 connection, u32 count

// Time of recording [ns] of the message at each offset of a chunk.
using MessageTimes = std::map<std::uint32_t, std::int64_t>;
// The same per connection.
using ChunkMessages = std::map<std::uint32_t, MessageTimes>;
// Messages per connection.
using MessageCounts = std::map<std::uint32_t, std::uint32_t>;

// The field `count` of a record of version 1, which must fit its data.
Result<std::size_t> entry_count(const BagRecord& record, std::size_t entry_bytes);

// Each entry takes its message out of `messages`, so that none is named twice. The data must be
// whole entries.
Result<void> match_index_entries(const BagRecord& record, const BagBytes& file,
                                 MessageTimes& messages);

// The data must be whole entries.
Result<void> match_chunk_counts(const BagRecord& record, const MessageCounts& counts);

}  // namespace corridor::formats
