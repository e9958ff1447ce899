// The files of the project as text, for tests about the shape of the tree itself.
// Reads the folder as it is on disk and leaves out what .gitignore leaves out; it knows no C++.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace corridor::architecture {

struct SourceFile {
  std::string path;  // from the root, with '/'
  std::vector<std::string> lines;

  // ".cpp"; empty if there is none.
  [[nodiscard]] std::string extension() const;
  // "slam/core"; empty for files at the root.
  [[nodiscard]] std::string folder() const;
  [[nodiscard]] bool is_cpp() const;   // .cpp or .hpp
  [[nodiscard]] bool is_code() const;  // .cpp, .hpp, .sh, .js, .css, .html
};

struct SourceTree {
  std::filesystem::path root;
  std::vector<SourceFile> files;          // sorted by path; text files only
  std::vector<std::string> root_entries;  // names of files and folders at the root, sorted

  [[nodiscard]] bool has(std::string_view path) const;
  [[nodiscard]] const SourceFile* find(std::string_view path) const;
};

SourceTree read_source_tree(const std::filesystem::path& root);

// One #include line.
struct Include {
  std::string path;
  std::size_t line_number = 0;  // from 1
  bool is_quoted = false;       // "..." rather than <...>
};

std::vector<Include> includes_of(const SourceFile& file);

// True if path is prefix itself or begins with it: starts_with_any("slam/core/a.hpp",
// {"slam/core/"}).
bool starts_with_any(std::string_view path, const std::vector<std::string_view>& prefixes);

// "slam/core/a.hpp:12: message", the form in which every rule reports.
std::string at_line(const SourceFile& file, std::size_t line_number, std::string_view message);

}  // namespace corridor::architecture
