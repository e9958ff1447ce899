#include "datasets/formats/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace corridor::formats {
namespace {

// By tables within tables no deeper than the parser goes.
bool states_nothing(const toml::table& table) {
  return std::all_of(table.cbegin(), table.cend(), [](const auto& item) {
    return item.second.is_table() && states_nothing(*item.second.as_table());
  });
}

}  // namespace

Result<toml::table> parse_toml_text(std::string_view text, std::string_view where) {
  try {
    toml::table document = toml::parse(text);
    if (!states_nothing(document)) return document;
    return fail(ErrorCode::kMalformed, "states nothing", std::string(where), "at least one key");
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kMalformed, std::string(error.description()),
                fmt::format("{}:{}", where, error.source().begin.line), "TOML");
  }
}

}  // namespace corridor::formats
