// Rules about files and folders: where they may lie, how long they are, what must stand beside them
// and what must not stand in them. They read text; they do not parse C++.
#pragma once

#include <string>
#include <vector>

#include "tests/architecture/source_tree.hpp"

namespace corridor::architecture {

inline constexpr std::size_t kMaxLinesPerFile = 400;

// Files and folders at the root besides the seven rooms and the listed files.
std::vector<std::string> strangers_at_the_root(const SourceTree& tree);

// Code files of more than kMaxLinesPerFile lines. Third-party files (names with ".min.") are
// exempt.
std::vector<std::string> files_too_long(const SourceTree& tree);

// Folders "room" or "room/part" that hold code, at any depth, and have no README.md. A folder
// deeper down is described by the README of its part.
std::vector<std::string> folders_without_readme(const SourceTree& tree);

std::vector<std::string> headers_without_pragma_once(const SourceTree& tree);

// Source files that no CMakeLists.txt in their folder or above names: dead files.
std::vector<std::string> sources_outside_the_build(const SourceTree& tree);

// Relative links of Markdown files that lead to no file or folder.
std::vector<std::string> broken_links(const SourceTree& tree);

// Marks of unfinished work and paths of one machine, in any text file.
std::vector<std::string> forbidden_words(const SourceTree& tree);

// In slam/ and baselines/: files, printing, clocks and generators of their own. A system gets
// events and an Rng; whoever drives it does the rest.
std::vector<std::string> forbidden_facilities(const SourceTree& tree);

}  // namespace corridor::architecture
