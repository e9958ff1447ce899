// The hash by which a Content-Security-Policy allows one style sheet [CSP3, section 2.3.1].
#pragma once

#include <string>

namespace corridor::html {

// "sha256-" and the base-64 digest of the element's content.
std::string csp_hash(const std::string& content);

}  // namespace corridor::html
