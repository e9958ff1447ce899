#include "bench/runner/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace corridor::runner {
namespace {

TEST(Printable, LeavesTextOfAnyLanguage) {
  const std::string text = "log-7 (3 %): Flur \xc3\xbc, \xe5\xbb\x8a, \xf0\x9f\x98\x80";
  EXPECT_EQ(printable(text), text);
}

TEST(Printable, ShowsControlCharactersAsTheirBytes) {
  EXPECT_EQ(printable("a\x1b[31mb\r\n\tc\x7f"), "a\\x1b[31mb\\x0d\\x0a\\x09c\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b") << "C1: the terminal's CSI";
}

TEST(Printable, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("a\xe5\xbb"), "a\\xe5\\xbb") << "cut short";
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b") << "an overlong ESC";
  EXPECT_EQ(printable("\xe0\x82\x9b"), "\\xe0\\x82\\x9b") << "an overlong CSI";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

}  // namespace
}  // namespace corridor::runner
