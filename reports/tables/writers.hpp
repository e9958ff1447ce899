// A Table as text: Markdown and HTML and LaTeX for people, with what is the same in every row said
// once (condensed.hpp); CSV for programs, with every column. All names are escaped.
#pragma once

#include <string>

#include "reports/tables/table.hpp"

namespace corridor::tables {

// "0.195", with a real minus sign left out: plain ASCII, fixed decimals, "-0.000" written as
// "0.000".
std::string number_text(double value, int decimals);
// "[0.150, 0.240]", "" without an interval.
std::string interval_text(const Estimate& estimate);
// "10/10".
std::string count_text(const Estimate& estimate);
// "0.195 [0.150, 0.240] (10/10)", the reason of what is missing, the text as it is.
std::string plain_text(const Cell& cell);

// Pipe table with caption and notes; the best value is bold.
std::string to_markdown(const Table& table);
// RFC 4180 with CRLF, header from Column::key; numbers with as many digits as give back the same
// double; an Estimate takes the columns KEY KEY_low KEY_high KEY_n KEY_of KEY_best. Missing is
// empty.
std::string to_csv(const Table& table);
// A table environment for booktabs and siunitx: needs \usepackage{booktabs,siunitx,textcomp}.
std::string to_latex(const Table& table);
// A <table> with caption, scope attributes and notes, for the page's style sheet.
std::string to_html(const Table& table);

}  // namespace corridor::tables
