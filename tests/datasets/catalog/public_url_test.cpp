#include "datasets/catalog/public_url.hpp"

#include <gtest/gtest.h>

namespace corridor::catalog {
namespace {

TEST(PublicUrl, IsHttpsAnywhereAndHttpOnThisMachineOnly) {
  for (const char* good :
       {"https://example.org", "https://example.org:8443/a/b.gz?c=d", "http://localhost/a",
        "http://localhost:8080/a", "http://127.0.0.1:1/a", "http://[::1]/a", "http://[::1]:80"}) {
    EXPECT_TRUE(check_public_url(good).has_value()) << good;
  }
  for (const char* bad :
       {"", "example.org/a", "http://example.org/a", "ftp://example.org/a", "file:///etc/passwd",
        "HTTPS://example.org", "https://", "https:///a", "http://localhost.example.org/a",
        "http://127.0.0.1.example.org/a", "http://localhost:80.example.org/",
        "http://localhost@example.org/", "https://user:secret@example.org/", "https://a b/",
        "https://a/\n", "https://a\\b/", "http://[::1].example.org/"}) {
    EXPECT_FALSE(check_public_url(bad).has_value()) << bad;
  }
}

}  // namespace
}  // namespace corridor::catalog
