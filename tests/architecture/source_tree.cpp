#include "tests/architecture/source_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

namespace corridor::architecture {

namespace {

constexpr std::array<std::string_view, 17> kTextExtensions{
    ".cpp",  ".hpp",   ".sh",  ".js",  ".css",  ".html", ".md", ".txt", ".toml",
    ".json", ".cmake", ".csv", ".tex", ".yaml", ".svg",  ".in", ""};

// What version control leaves out: build folders, results, caches, editors' notes.
bool is_ignored(const std::string& path) {
  constexpr std::array<std::string_view, 6> kIgnored{".git",   "build", "reports/out",
                                                     ".cache", ".idea", ".vscode"};
  return std::ranges::find(kIgnored, path) != kIgnored.end() || path == "compile_commands.json";
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file, std::ios::binary);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::string SourceFile::extension() const {
  return std::filesystem::path(path).extension().string();
}

std::string SourceFile::folder() const {
  return std::filesystem::path(path).parent_path().generic_string();
}

bool SourceFile::is_cpp() const { return path.ends_with(".cpp") || path.ends_with(".hpp"); }

bool SourceFile::is_code() const {
  constexpr std::array<std::string_view, 4> kOthers{".sh", ".js", ".css", ".html"};
  return is_cpp() || std::ranges::find(kOthers, extension()) != kOthers.end();
}

bool SourceTree::has(std::string_view path) const { return find(path) != nullptr; }

const SourceFile* SourceTree::find(std::string_view path) const {
  const auto found = std::ranges::lower_bound(files, path, {}, &SourceFile::path);
  return found != files.end() && found->path == path ? &*found : nullptr;
}

SourceTree read_source_tree(const std::filesystem::path& root) {
  SourceTree tree{.root = root, .files = {}, .root_entries = {}};
  using Walk = std::filesystem::recursive_directory_iterator;
  for (auto entry = Walk(root); entry != Walk(); ++entry) {
    const std::string path = std::filesystem::relative(entry->path(), root).generic_string();
    if (is_ignored(path)) {
      entry.disable_recursion_pending();
      continue;
    }
    if (entry.depth() == 0) tree.root_entries.push_back(path);
    if (!entry->is_regular_file()) continue;
    SourceFile file{.path = path, .lines = {}};
    if (std::ranges::find(kTextExtensions, file.extension()) == kTextExtensions.end()) continue;
    file.lines = lines_of(entry->path());
    tree.files.push_back(std::move(file));
  }
  std::ranges::sort(tree.files, {}, &SourceFile::path);
  std::ranges::sort(tree.root_entries);
  return tree;
}

std::vector<Include> includes_of(const SourceFile& file) {
  std::vector<Include> includes;
  for (std::size_t index = 0; index < file.lines.size(); ++index) {
    const std::string& line = file.lines[index];
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#') continue;
    const std::size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos || line.compare(word, 7, "include") != 0) continue;
    const std::size_t open = line.find_first_of("\"<", word + 7);
    if (open == std::string::npos) continue;
    const bool is_quoted = line[open] == '"';
    const std::size_t close = line.find(is_quoted ? '"' : '>', open + 1);
    if (close == std::string::npos) continue;
    includes.push_back({line.substr(open + 1, close - open - 1), index + 1, is_quoted});
  }
  return includes;
}

bool starts_with_any(std::string_view path, const std::vector<std::string_view>& prefixes) {
  return std::ranges::any_of(prefixes,
                             [&](std::string_view prefix) { return path.starts_with(prefix); });
}

std::string at_line(const SourceFile& file, std::size_t line_number, std::string_view message) {
  return fmt::format("{}:{}: {}", file.path, line_number, message);
}

}  // namespace corridor::architecture
