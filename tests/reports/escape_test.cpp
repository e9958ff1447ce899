// Escaping keeps names what they are: text.
#include "reports/escape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace corridor::reports {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// A second implementation that goes the other way.
std::string unescape_html(std::string text) {
  text = replace_all(std::move(text), "&lt;", "<");
  text = replace_all(std::move(text), "&gt;", ">");
  text = replace_all(std::move(text), "&quot;", "\"");
  text = replace_all(std::move(text), "&#39;", "'");
  return replace_all(std::move(text), "&amp;", "&");
}

// The fields of one RFC 4180 record.
std::vector<std::string> read_csv_record(const std::string& record) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t index = 0; index < record.size(); ++index) {
    const char character = record[index];
    if (character == '"' && is_quoted && index + 1 < record.size() && record[index + 1] == '"') {
      fields.back() += '"';
      ++index;
    } else if (character == '"') {
      is_quoted = !is_quoted;
    } else if (character == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += character;
    }
  }
  return fields;
}

TEST(ValidUtf8, KeepsWellFormedTextAndReplacesTheRest) {
  EXPECT_EQ(valid_utf8("a\tb\nc"), "a\tb\nc");
  EXPECT_EQ(valid_utf8("Größe مرحبا 𝛼"), "Größe مرحبا 𝛼");
  EXPECT_EQ(valid_utf8("a\x01\x7F"), "a\uFFFD\uFFFD");
  EXPECT_EQ(valid_utf8("\xC0\xAF"), "\uFFFD\uFFFD");                 // overlong '/'
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");       // surrogate
  EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80").substr(0, 3), "\uFFFD");  // beyond Unicode
  EXPECT_EQ(valid_utf8("\xE2\x82"), "\uFFFD\uFFFD");                 // cut short
}

RC_GTEST_PROP(ValidUtf8, IsIdempotent, (const std::string& text)) {
  const std::string once = valid_utf8(text);
  RC_ASSERT(valid_utf8(once) == once);
}

RC_GTEST_PROP(EscapeHtml, LeavesNoMarkupAndCanBeUndone, (const std::string& text)) {
  const std::string escaped = escape_html(text);
  RC_ASSERT(escaped.find_first_of("<>\"'") == std::string::npos);
  RC_ASSERT(unescape_html(escaped) == valid_utf8(text));
}

RC_GTEST_PROP(EscapeCsv, IsReadBackByAnotherReaderAsOneField, (const std::string& text)) {
  const auto fields = read_csv_record(escape_csv(text) + "," + escape_csv("next"));
  RC_ASSERT(fields.size() == 2u);
  RC_ASSERT(fields[0] == valid_utf8(text));
}

RC_GTEST_PROP(EscapeLatex, LeavesNoCharacterThatStartsAComment, (const std::string& text)) {
  const std::string escaped = escape_latex(text);
  for (const char special : std::string("%$#&_")) {
    for (std::size_t at = escaped.find(special); at != std::string::npos;
         at = escaped.find(special, at + 1)) {
      RC_ASSERT(at > 0u);
      RC_ASSERT(escaped[at - 1] == '\\');
    }
  }
}

RC_GTEST_PROP(EscapeMarkdown, LeavesNoCellEnd, (const std::string& text)) {
  const std::string escaped = escape_markdown(text);
  RC_ASSERT(escaped.find('\n') == std::string::npos);
  for (std::size_t at = escaped.find('|'); at != std::string::npos;
       at = escaped.find('|', at + 1)) {
    RC_ASSERT(at > 0u);
    RC_ASSERT(escaped[at - 1] == '\\');
  }
}

TEST(EscapeLatex, WritesSpecialCharactersByName) {
  EXPECT_EQ(escape_latex("50%_a^b~{c}\\d"),
            "50\\%\\_a\\textasciicircum{}b\\textasciitilde{}\\{c\\}\\textbackslash{}d");
}

RC_GTEST_PROP(FileNameFrom, IsAlwaysAPlainShortName, (const std::string& text)) {
  const std::string name = file_name_from(text);
  RC_ASSERT(!name.empty());
  RC_ASSERT(name.size() <= 80u);
  RC_ASSERT(name.front() != '.');
  RC_ASSERT(name.find('/') == std::string::npos);
}

TEST(FileNameFrom, KeepsPlainNamesAndTellsOthersApart) {
  EXPECT_EQ(file_name_from("corridor-r4.5-s1"), "corridor-r4.5-s1");
  EXPECT_NE(file_name_from("a/b"), file_name_from("a:b"));
  EXPECT_NE(file_name_from(std::string(300, 'x')), file_name_from(std::string(301, 'x')));
  EXPECT_THAT(file_name_from("../../etc"), Not(HasSubstr("/")));
}

TEST(UrlFromPath, CanBeNoOtherScheme) {
  EXPECT_EQ(url_from_path("tables/a b.csv"), "tables/a%20b.csv");
  EXPECT_EQ(url_from_path("javascript:alert(1)"), "javascript%3Aalert%281%29");
}

TEST(Base64, EqualsTheExamplesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE"), "//4=");
}

}  // namespace
}  // namespace corridor::reports
