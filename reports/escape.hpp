// Text as each output format needs it, so that no name of a system, data set or file can change the
// meaning of what stands around it. Invalid UTF-8 and control characters become U+FFFD everywhere.
#pragma once

#include <string>
#include <string_view>

namespace corridor::reports {

// Every byte sequence that is not UTF-8, and every control character but tab and line feed,
// replaced.
std::string valid_utf8(std::string_view text);

// HTML and SVG, in text and in quoted attributes: & < > " '.
std::string escape_html(std::string_view text);
// LaTeX running text: \ { } $ & # _ % ^ ~ < > | " and line feeds.
std::string escape_latex(std::string_view text);
// A cell of a pipe table: what Markdown or HTML inside it would read as markup; line feeds become
// blanks.
std::string escape_markdown(std::string_view text);
// A field of RFC 4180: quoted where it must be, quotes doubled.
std::string escape_csv(std::string_view text);

// A file name made of text: letters, digits, '.', '-' and '_' stay, the rest becomes '-'; at most
// 80 bytes, never empty, never starting with a dot. Names that lost something end in a hash of all
// of the text, so that different texts keep different files.
std::string file_name_from(std::string_view text);

// A relative or absolute path as the value of href: percent-encoded, so that it can be no other
// scheme.
std::string url_from_path(std::string_view path);

// RFC 4648 base 64, for data: URLs.
std::string base64(std::string_view bytes);

}  // namespace corridor::reports
