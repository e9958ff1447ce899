// UTF-8 is checked by hand: the table of well-formed sequences is Unicode 15.0, table 3-7.
#include "reports/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace corridor::reports {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::size_t kMaxFileNameBytes = 80;

bool is_continuation(unsigned char byte) { return (byte & 0xC0U) == 0x80U; }

// Length in bytes of the well-formed character at the front of `text`; 0 if there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t index) { return static_cast<unsigned char>(text[index]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t index = 1; index < length; ++index) {
    if (!is_continuation(byte(index))) return 0;
  }
  const unsigned char second = byte(1);
  if (first == 0xE0 && second < 0xA0) return 0;  // overlong
  if (first == 0xED && second > 0x9F) return 0;  // surrogates
  if (first == 0xF0 && second < 0x90) return 0;  // overlong
  if (first == 0xF4 && second > 0x8F) return 0;  // beyond U+10FFFF
  return length;
}

bool is_control(std::string_view character) {
  const auto byte = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return (byte < 0x20 && byte != '\t' && byte != '\n') || byte == 0x7F;
  // U+FFFE and U+FFFF are no XML characters; U+0080 to U+009F are controls.
  return character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF" ||
         (byte == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

template <class Substitute>
std::string map_characters(std::string_view text, Substitute&& substitute) {
  std::string result;
  for (const char character : valid_utf8(text)) {
    const std::string_view other = substitute(character);
    if (other.data() == nullptr) {
      result += character;
    } else {
      result += other;
    }
  }
  return result;
}

constexpr std::string_view kAsIs{};

std::string_view html_substitute(char character) {
  switch (character) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return kAsIs;
  }
}

std::string_view latex_substitute(char character) {
  switch (character) {
    case '\\':
      return "\\textbackslash{}";
    case '{':
      return "\\{";
    case '}':
      return "\\}";
    case '$':
      return "\\$";
    case '&':
      return "\\&";
    case '#':
      return "\\#";
    case '_':
      return "\\_";
    case '%':
      return "\\%";
    case '^':
      return "\\textasciicircum{}";
    case '~':
      return "\\textasciitilde{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '"':
      return "\\textquotedbl{}";
    case '[':
      return "{[}";  // after \\ it would be an option
    case ']':
      return "{]}";
    case '\n':
      return " ";
    default:
      return kAsIs;
  }
}

std::string_view markdown_substitute(char character) {
  switch (character) {
    case '\\':
      return "\\\\";
    case '|':
      return "\\|";
    case '*':
      return "\\*";
    case '_':
      return "\\_";
    case '`':
      return "\\`";
    case '[':
      return "\\[";
    case ']':
      return "\\]";
    case '~':
      return "\\~";
    case '$':
      return "\\$";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '&':
      return "&amp;";
    case '\n':
      return " ";
    default:
      return kAsIs;
  }
}

// FNV-1a, 64 bits: to tell file names apart, nothing more.
std::uint64_t fingerprint(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char character : text) {
    hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3ULL;
  }
  return hash;
}

bool is_plain(char character) {
  return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
         (character >= '0' && character <= '9') || character == '-' || character == '_' ||
         character == '.';
}

}  // namespace

std::string valid_utf8(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    result += length == 0 || is_control(character) ? kReplacement : character;
    text.remove_prefix(character.size());
  }
  return result;
}

std::string escape_html(std::string_view text) { return map_characters(text, html_substitute); }
std::string escape_latex(std::string_view text) { return map_characters(text, latex_substitute); }
std::string escape_markdown(std::string_view text) {
  return map_characters(text, markdown_substitute);
}

std::string escape_csv(std::string_view text) {
  std::string valid = valid_utf8(text);
  if (valid.find_first_of(",\"\n") == std::string::npos) return valid;
  std::string result = "\"";
  for (const char character : valid) {
    if (character == '"') result += '"';
    result += character;
  }
  return result + '"';
}

std::string file_name_from(std::string_view text) {
  std::string name;
  for (const char character : text) name += is_plain(character) ? character : '-';
  if (!name.empty() && name.front() == '.') name.front() = '-';
  if (!name.empty() && name == text && name.size() <= kMaxFileNameBytes) return name;
  const std::string suffix = fmt::format("-{:016x}", fingerprint(text));
  return name.substr(0, kMaxFileNameBytes - suffix.size()) + suffix;
}

std::string url_from_path(std::string_view path) {
  std::string url;
  for (const char character : path) {
    if (is_plain(character) || character == '/') {
      url += character;
    } else {
      url += fmt::format("%{:02X}", static_cast<unsigned char>(character));
    }
  }
  return url;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t begin = 0; begin < bytes.size(); begin += 3) {
    const std::string_view group = bytes.substr(begin, 3);
    std::uint32_t bits = 0;
    for (std::size_t index = 0; index < 3; ++index) {
      bits = (bits << 8U) | (index < group.size() ? static_cast<unsigned char>(group[index]) : 0U);
    }
    for (std::size_t index = 0; index < 4; ++index) {
      text += index <= group.size() ? kAlphabet[(bits >> (18U - 6U * index)) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace corridor::reports
