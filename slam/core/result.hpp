// What a function returns when the outside world (a file, an option, data) may be wrong.
// Numerical trouble is not an Error: solvers report it as a status in their own record.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace corridor {

enum class ErrorCode {
  kNotFound,       // a file or a name that does not exist
  kUnreadable,     // exists, but cannot be opened, decompressed or written
  kMalformed,      // syntax: truncated, garbage, wrong number of fields
  kInvalid,        // syntax is fine, a value breaks a rule
  kUnsupported,    // understood, but this build or format cannot hold it
  kResourceLimit,  // more time, memory or size than allowed
  kInternal,       // a third-party library failed
};

// One line for the user: what happened, where (file:line, byte offset or option), what was
// expected.
struct Error {
  ErrorCode code = ErrorCode::kInvalid;
  std::string what;
  std::string where;
  std::string expected;

  [[nodiscard]] std::string to_line() const {
    std::string line = where.empty() ? what : where + ": " + what;
    if (!expected.empty()) line += "; expected " + expected;
    return line;
  }
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string where = {},
                                  std::string expected = {}) {
  return tl::make_unexpected(Error{code, std::move(what), std::move(where), std::move(expected)});
}

}  // namespace corridor
