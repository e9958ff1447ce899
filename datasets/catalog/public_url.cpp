#include "datasets/catalog/public_url.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace corridor::catalog {
namespace {

constexpr std::string_view kHttps = "https://";
constexpr std::string_view kHttp = "http://";
constexpr std::array<std::string_view, 3> kLoopback = {"localhost", "127.0.0.1", "[::1]"};

bool is_plain(char character) {
  return character > ' ' && character < '\x7f' && character != '\\' && character != '"';
}

// "host:port" of what follows the scheme.
std::string_view authority_of(std::string_view rest) {
  return rest.substr(0, rest.find_first_of("/?#"));
}

bool is_loopback(std::string_view authority) {
  return std::any_of(kLoopback.begin(), kLoopback.end(), [authority](std::string_view host) {
    if (!authority.starts_with(host)) return false;
    const std::string_view port = authority.substr(host.size());
    return port.empty() || (port.front() == ':' &&
                            port.find_first_not_of("0123456789", 1) == std::string_view::npos);
  });
}

}  // namespace

Result<void> check_public_url(std::string_view url) {
  const auto refused = [url](const char* what) {
    return fail(ErrorCode::kInvalid, what, std::string(url),
                "https://..., or http://... of this machine itself");
  };
  if (!std::all_of(url.begin(), url.end(), is_plain)) {
    return refused("the address has blanks, quotes or control characters");
  }
  const bool is_https = url.starts_with(kHttps);
  if (!is_https && !url.starts_with(kHttp)) return refused("the address is neither https nor http");
  const std::string_view authority =
      authority_of(url.substr(is_https ? kHttps.size() : kHttp.size()));
  if (authority.empty()) return refused("the address has no host");
  if (authority.find('@') != std::string_view::npos) {
    return refused("the address holds a user name");
  }
  if (!is_https && !is_loopback(authority)) return refused("http leaves this machine");
  return {};
}

bool is_loopback_http(std::string_view url) { return url.starts_with(kHttp); }

}  // namespace corridor::catalog
