// Which addresses data may be fetched from.
#pragma once

#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::catalog {

// "https://HOST[:PORT][/...]", or the same with http where HOST is this machine itself: localhost,
// 127.0.0.1 or [::1]. No user names, blanks or control characters.
Result<void> check_public_url(std::string_view url);

// http, and therefore this machine itself. For a URL that check_public_url() accepts.
bool is_loopback_http(std::string_view url);

}  // namespace corridor::catalog
