// A TOML text as a document. Internal to datasets/: it shows the TOML library, so only .cpp files
// include it.
#pragma once

#include <toml++/toml.h>

#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

// The Error names the line of `where` in which the syntax is broken. A text without a key, be it
// tables of none, is one too: all defaults would pass for what somebody asked for.
Result<toml::table> parse_toml_text(std::string_view text, std::string_view where);

}  // namespace corridor::formats
