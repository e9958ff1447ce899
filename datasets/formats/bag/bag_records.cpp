#include "datasets/formats/bag/bag_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "bags are read as they lie in memory");

constexpr std::int64_t kNanoseconds = 1'000'000'000;
// rosbag writes at most seven; every new one is compared with all before.
constexpr std::size_t kMaxFields = 64;

template <class T>
T number_at(std::string_view bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// A length at `offset` and what it counts, all within `end`.
Result<std::uint32_t> take_length(const BagBytes& from, std::size_t offset, std::size_t end,
                                  const char* what) {
  if (end - offset < sizeof(std::uint32_t)) {
    return fail(ErrorCode::kMalformed, fmt::format("ends before the length of {}", what),
                from.at(offset), "4 bytes");
  }
  const std::uint32_t length = u32_at(from.bytes, offset);
  const std::size_t left = end - offset - sizeof(std::uint32_t);
  if (length > left) {
    return fail(ErrorCode::kMalformed, fmt::format("{} of {} bytes", what, length), from.at(offset),
                fmt::format("at most the {} bytes that follow", left));
  }
  return length;
}

template <class T>
Result<T> number_field(const BagFields& fields, std::string_view name, const std::string& where) {
  const auto text = text_field(fields, name, where);
  if (!text) return tl::make_unexpected(text.error());
  if (text->size() != sizeof(T)) {
    return fail(ErrorCode::kMalformed, fmt::format("field {} of {} bytes", name, text->size()),
                where, fmt::format("{}", sizeof(T)));
  }
  return number_at<T>(*text, 0);
}

}  // namespace

std::string BagBytes::at(std::size_t offset) const {
  return fmt::format("{}: byte {}", name, offset);
}

std::uint32_t u32_at(std::string_view bytes, std::size_t offset) {
  return number_at<std::uint32_t>(bytes, offset);
}

std::uint64_t u64_at(std::string_view bytes, std::size_t offset) {
  return number_at<std::uint64_t>(bytes, offset);
}

Result<BagFields> take_bag_fields(const BagBytes& from, std::size_t begin, std::size_t end) {
  BagFields fields;
  for (std::size_t offset = begin; offset < end;) {
    const auto length = take_length(from, offset, end, "a header field");
    if (!length) return tl::make_unexpected(length.error());
    const std::string_view field = from.bytes.substr(offset + sizeof(std::uint32_t), *length);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return fail(ErrorCode::kMalformed, "header field " + quote(field), from.at(offset),
                  "name=value");
    }
    const std::string_view name = field.substr(0, equals);
    const bool is_known = std::any_of(fields.begin(), fields.end(),
                                      [&](const auto& known) { return known.first == name; });
    if (is_known) {
      return fail(ErrorCode::kMalformed, fmt::format("header field {} twice", quote(name)),
                  from.at(offset), "each field once");
    }
    if (fields.size() == kMaxFields) {
      return fail(ErrorCode::kResourceLimit, "too many header fields", from.at(offset),
                  fmt::format("at most {}", kMaxFields));
    }
    fields.emplace_back(name, field.substr(equals + 1));
    offset += sizeof(std::uint32_t) + *length;
  }
  return fields;
}

Result<BagRecord> take_bag_record(const BagBytes& from, std::size_t offset) {
  BagRecord record;
  record.begin = offset;
  record.where = from.at(offset);
  const std::size_t end = from.bytes.size();
  const auto header_length = take_length(from, offset, end, "a record's header");
  if (!header_length) return tl::make_unexpected(header_length.error());
  if (*header_length > kMaxBagHeaderBytes) {
    return fail(ErrorCode::kResourceLimit,
                fmt::format("a record's header of {} bytes", *header_length), record.where,
                fmt::format("at most {}", kMaxBagHeaderBytes));
  }
  const std::size_t header_begin = offset + sizeof(std::uint32_t);
  const std::size_t header_end = header_begin + *header_length;
  auto fields = take_bag_fields(from, header_begin, header_end);
  if (!fields) return tl::make_unexpected(fields.error());
  record.fields = std::move(*fields);
  const auto op = number_field<std::uint8_t>(record.fields, "op", record.where);
  if (!op) return tl::make_unexpected(op.error());
  record.op = *op;
  const auto data_length = take_length(from, header_end, end, "a record's data");
  if (!data_length) return tl::make_unexpected(data_length.error());
  record.data_begin = header_end + sizeof(std::uint32_t);
  record.data = from.bytes.substr(record.data_begin, *data_length);
  record.end = record.data_begin + *data_length;
  return record;
}

Result<std::string_view> text_field(const BagFields& fields, std::string_view name,
                                    const std::string& where) {
  for (const auto& [known, value] : fields) {
    if (known == name) return value;
  }
  return fail(ErrorCode::kMalformed, fmt::format("header without the field {}", name), where,
              fmt::format("{}=", name));
}

Result<std::uint32_t> u32_field(const BagFields& fields, std::string_view name,
                                const std::string& where) {
  return number_field<std::uint32_t>(fields, name, where);
}

Result<std::uint64_t> u64_field(const BagFields& fields, std::string_view name,
                                const std::string& where) {
  return number_field<std::uint64_t>(fields, name, where);
}

Result<std::int64_t> time_field(const BagFields& fields, std::string_view name,
                                const std::string& where) {
  const auto time = number_field<std::uint64_t>(fields, name, where);
  if (!time) return tl::make_unexpected(time.error());
  const auto seconds = static_cast<std::int64_t>(*time & 0xffff'ffffu);
  const auto nanoseconds = static_cast<std::int64_t>(*time >> 32u);
  if (nanoseconds >= kNanoseconds) {
    return fail(ErrorCode::kMalformed, fmt::format("{} of {} nanoseconds", name, nanoseconds),
                where, "less than a second of them");
  }
  return seconds * kNanoseconds + nanoseconds;
}

}  // namespace corridor::formats
