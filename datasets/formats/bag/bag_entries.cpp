#include "datasets/formats/bag/bag_entries.hpp"

#include <fmt/format.h>

namespace corridor::formats {
namespace {

constexpr std::uint32_t kVersion = 1;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

Result<std::size_t> entry_count(const BagRecord& record, std::size_t entry_bytes) {
  const auto version = u32_field(record.fields, "ver", record.where);
  if (!version) return tl::make_unexpected(version.error());
  if (*version != kVersion) {
    return fail(ErrorCode::kUnsupported, fmt::format("record of version {}", *version),
                record.where, fmt::format("{}", kVersion));
  }
  const auto count = u32_field(record.fields, "count", record.where);
  if (!count) return tl::make_unexpected(count.error());
  if (*count * entry_bytes != record.data.size()) {
    return fail(ErrorCode::kMalformed,
                fmt::format("{} entries in {} bytes", *count, record.data.size()), record.where,
                fmt::format("{} bytes", *count * entry_bytes));
  }
  return *count;
}

Result<void> match_index_entries(const BagRecord& record, const BagBytes& file,
                                 MessageTimes& messages) {
  for (std::size_t at = 0; at < record.data.size(); at += kIndexEntryBytes) {
    const std::int64_t time_ns = u32_at(record.data, at) * kSecond_ns + u32_at(record.data, at + 4);
    const std::uint32_t offset = u32_at(record.data, at + 8);
    const auto message = messages.find(offset);
    if (message == messages.end() || message->second != time_ns) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("index entry for byte {} of the chunk, {} ns", offset, time_ns),
                  file.at(record.data_begin + at),
                  message == messages.end() ? "the byte of a message of its connection"
                                            : fmt::format("{} ns", message->second));
    }
    messages.erase(message);
  }
  return {};
}

Result<void> match_chunk_counts(const BagRecord& record, const MessageCounts& counts) {
  MessageCounts stated;
  for (std::size_t at = 0; at < record.data.size(); at += kChunkInfoEntryBytes) {
    stated[u32_at(record.data, at)] += u32_at(record.data, at + 4);
  }
  if (stated == counts && record.data.size() == counts.size() * kChunkInfoEntryBytes) return {};
  return fail(ErrorCode::kInvalid, "a chunk's info counts other messages than the chunk has",
              record.where, fmt::format("those of {} connections", counts.size()));
}

}  // namespace corridor::formats
