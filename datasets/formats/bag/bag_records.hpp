// The records a ROS 1 bag (V2.0) is made of, taken apart with every length checked:
//   u32 header length, header, u32 data length, data; header = fields of u32 length, name=value
// all little endian. Internal to this folder; what records may follow which is bag_framing's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::formats {

// Headers hold names and numbers; message definitions are data.
inline constexpr std::uint32_t kMaxBagHeaderBytes = 1u << 16;

// Bytes with a name for messages: a file, or the content of one of its chunks.
struct BagBytes {
  std::string_view bytes;
  std::string name;  // "a.bag" or "a.bag: chunk at byte 4117"

  [[nodiscard]] std::string at(std::size_t offset) const;  // "a.bag: byte 13"
};

using BagFields = std::vector<std::pair<std::string_view, std::string_view>>;

struct BagRecord {
  std::uint8_t op = 0;
  BagFields fields;
  std::string_view data;
  std::size_t begin = 0;  // offset of the record
  std::size_t data_begin = 0;
  std::size_t end = 0;  // offset behind the record
  std::string where;    // of the record, for messages
};

// An Error names the byte: a length that leads beyond the end, a header beyond its cap, too many
// fields, a field without '=', a field given twice, no field "op".
Result<BagRecord> take_bag_record(const BagBytes& from, std::size_t offset);

// The fields of a header, or of a connection's data, which has the same form.
Result<BagFields> take_bag_fields(const BagBytes& from, std::size_t begin, std::size_t end);

// The value of a field; the Error says which one `where` lacks, or that it has another size.
Result<std::string_view> text_field(const BagFields& fields, std::string_view name,
                                    const std::string& where);
Result<std::uint32_t> u32_field(const BagFields& fields, std::string_view name,
                                const std::string& where);
Result<std::uint64_t> u64_field(const BagFields& fields, std::string_view name,
                                const std::string& where);
// ROS time: u32 seconds, u32 nanoseconds, in nanoseconds.
Result<std::int64_t> time_field(const BagFields& fields, std::string_view name,
                                const std::string& where);

// Little-endian number at `offset`; the bytes must be there.
std::uint32_t u32_at(std::string_view bytes, std::size_t offset);
std::uint64_t u64_at(std::string_view bytes, std::size_t offset);

}  // namespace corridor::formats
