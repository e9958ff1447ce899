// Walks along the bytes of a binary log: every step is checked against the end, and the first thing
// wrong is kept as the Error. It knows no format. Numbers are big endian, as LCM writes them.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "slam/core/result.hpp"

namespace corridor::formats {

class ByteWalker {
 public:
  // `begin` is where `bytes` stand in the decompressed file, for messages.
  ByteWalker(std::string_view bytes, const std::string& file, std::size_t begin = 0)
      : bytes_(bytes), file_(file), begin_(begin) {}

  [[nodiscard]] bool at_end() const { return offset_ == bytes_.size(); }
  [[nodiscard]] bool has_failed() const { return error_.has_value(); }
  [[nodiscard]] const Error& error() const { return *error_; }
  // In the file.
  [[nodiscard]] std::size_t offset() const { return begin_ + offset_; }
  [[nodiscard]] std::size_t num_left() const { return bytes_.size() - offset_; }

  void refuse(std::size_t offset, std::string what, std::string expected,
              ErrorCode code = ErrorCode::kMalformed) {
    if (has_failed()) return;
    error_ = Error{code, std::move(what), fmt::format("{}: byte {}", file_, offset),
                   std::move(expected)};
  }

  // Empty once something was wrong.
  std::string_view take_bytes(std::size_t num_bytes, std::string_view what) {
    if (has_failed()) return {};
    if (num_bytes > num_left()) {
      refuse(begin_ + bytes_.size(), fmt::format("the data end inside {}", what),
             fmt::format("{} more bytes", num_bytes - num_left()));
      return {};
    }
    const std::string_view taken = bytes_.substr(offset_, num_bytes);
    offset_ += num_bytes;
    return taken;
  }

  // An integer, or a float as IEEE 754 has it; 0 once something was wrong.
  template <class T>
  T take(std::string_view what) {
    if constexpr (std::is_same_v<T, float>) {
      return std::bit_cast<float>(take<std::uint32_t>(what));
    } else {
      std::make_unsigned_t<T> value = 0;
      for (const char byte : take_bytes(sizeof(T), what)) {
        value = static_cast<std::make_unsigned_t<T>>((static_cast<std::uint64_t>(value) << 8U) |
                                                     static_cast<unsigned char>(byte));
      }
      return static_cast<T>(value);
    }
  }

 private:
  std::string_view bytes_;
  const std::string& file_;
  std::size_t begin_;
  std::size_t offset_ = 0;
  std::optional<Error> error_;
};

}  // namespace corridor::formats
