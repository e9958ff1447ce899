#include "tests/architecture/tree_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <string_view>

namespace corridor::architecture {

namespace {

bool contains_word(std::string_view line, std::string_view word) {
  for (std::size_t at = line.find(word); at != std::string_view::npos;
       at = line.find(word, at + 1)) {
    const auto is_letter = [&](std::size_t index) {
      const auto letter = static_cast<unsigned char>(line[index]);
      return std::isalnum(letter) != 0 || letter == '_';
    };
    const bool begins = at == 0 || !is_letter(at - 1);
    const bool ends = at + word.size() == line.size() || !is_letter(at + word.size());
    if (begins && ends) return true;
  }
  return false;
}

// True if the CMakeLists.txt of the folder, or of a folder above, names the file relative to
// itself.
bool is_in_build(const SourceTree& tree, const SourceFile& file) {
  for (std::string folder = file.folder();;) {
    const std::string prefix = folder.empty() ? "" : folder + "/";
    const std::string_view name = std::string_view(file.path).substr(prefix.size());
    if (const SourceFile* list = tree.find(prefix + "CMakeLists.txt")) {
      const auto names_it = [&](const std::string& line) {
        for (std::size_t at = line.find(name); at != std::string::npos;
             at = line.find(name, at + 1)) {
          if (at == 0 || std::string_view(" \t(\"/").find(line[at - 1]) != std::string_view::npos) {
            return true;
          }
        }
        return false;
      };
      if (std::ranges::any_of(list->lines, names_it)) return true;
    }
    if (folder.empty()) return false;
    const std::size_t slash = folder.rfind('/');
    folder = slash == std::string::npos ? "" : folder.substr(0, slash);
  }
}

}  // namespace

std::vector<std::string> strangers_at_the_root(const SourceTree& tree) {
  static const std::set<std::string, std::less<>> kKnown{
      ".ci",        ".clang-format",     ".clang-tidy",     ".gitattributes",
      ".gitignore", "CHANGELOG.md",      "CMakeLists.txt",  "LICENSE",
      "README.md",  "CMakePresets.json", "CONTRIBUTING.md", "baselines",
      "bench",      "datasets",          "reports",         "slam",
      "tests"};
  std::vector<std::string> found;
  for (const std::string& entry : tree.root_entries) {
    if (!kKnown.contains(entry)) found.push_back(entry + ": not one of the rooms and root files");
  }
  return found;
}

std::vector<std::string> files_too_long(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.is_code() || file.path.find(".min.") != std::string::npos) continue;
    if (file.lines.size() <= kMaxLinesPerFile) continue;
    found.push_back(fmt::format("{}: {} lines, at most {} allowed", file.path, file.lines.size(),
                                kMaxLinesPerFile));
  }
  return found;
}

std::vector<std::string> folders_without_readme(const SourceTree& tree) {
  std::set<std::string> folders;
  for (const SourceFile& file : tree.files) {
    if (!file.is_cpp()) continue;
    // The tests mirror the tree: one page describes them all.
    folders.insert(file.path.starts_with("tests/") ? "tests" : file.folder());
  }
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    if (!tree.has(folder + "/README.md")) found.push_back(folder + ": has code and no README.md");
  }
  return found;
}

std::vector<std::string> headers_without_pragma_once(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.path.ends_with(".hpp")) continue;
    if (std::ranges::count(file.lines, "#pragma once") != 1) {
      found.push_back(at_line(file, 1, "needs one line '#pragma once'"));
    }
  }
  return found;
}

std::vector<std::string> sources_outside_the_build(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (file.path.ends_with(".cpp") && !is_in_build(tree, file)) {
      found.push_back(at_line(file, 1, "no CMakeLists.txt names this file"));
    }
  }
  return found;
}

std::vector<std::string> broken_links(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (file.extension() != ".md") continue;
    for (std::size_t index = 0; index < file.lines.size(); ++index) {
      const std::string& line = file.lines[index];
      for (std::size_t at = line.find("]("); at != std::string::npos;
           at = line.find("](", at + 1)) {
        const std::string target = line.substr(at + 2, line.find_first_of(")#", at + 2) - at - 2);
        if (target.empty() || target.find("://") != std::string::npos) continue;
        if (std::filesystem::exists(tree.root / file.folder() / target)) continue;
        found.push_back(at_line(file, index + 1, "leads nowhere: " + target));
      }
    }
  }
  return found;
}

std::vector<std::string> forbidden_words(const SourceTree& tree) {
  // Put together here, so that this file does not contain what it looks for.
  static const std::array<std::string, 7> kWords{
      std::string("TO") + "DO", std::string("FIX") + "ME",           std::string("XX") + "X",
      std::string("HA") + "CK", std::string("not imple") + "mented", std::string("st") + "ub",
      std::string("st") + "ubs"};
  static const std::array<std::string, 3> kPaths{
      std::string("/wo") + "rk/", std::string("/ro") + "ot/", std::string("/t") + "mp/"};
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (file.path.find(".min.") != std::string::npos) continue;
    for (std::size_t index = 0; index < file.lines.size(); ++index) {
      const std::string& line = file.lines[index];
      for (const std::string& word : kWords) {
        if (contains_word(line, word)) found.push_back(at_line(file, index + 1, "says " + word));
      }
      for (const std::string& path : kPaths) {
        if (line.find(path) != std::string::npos) {
          found.push_back(at_line(file, index + 1, "names a path of one machine: " + path));
        }
      }
    }
  }
  return found;
}

std::vector<std::string> forbidden_facilities(const SourceTree& tree) {
  constexpr std::array<std::string_view, 12> kFacilities{
      "<iostream>", "<fstream>",  "<cstdio>",  "<random>",  "<filesystem>", "<fmt/color.h>",
      "printf",     "fmt::print", "std::cout", "std::cerr", "std::rand",    "getenv"};
  constexpr std::array<std::string_view, 3> kClocks{"system_clock", "steady_clock",
                                                    "high_resolution_clock"};
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.is_cpp() || !starts_with_any(file.path, {"slam/", "baselines/"})) continue;
    // A broken contract (a mistake of the programmer) prints its place and stops.
    if (file.path == "slam/core/expect.cpp") continue;
    const bool may_read_clock = file.path.starts_with("slam/core/stage_clock");
    for (std::size_t index = 0; index < file.lines.size(); ++index) {
      const std::string& line = file.lines[index];
      const auto stands_here = [&](std::string_view word) {
        return line.find(word) != std::string::npos;
      };
      if (std::ranges::any_of(kFacilities, stands_here) ||
          (!may_read_clock && std::ranges::any_of(kClocks, stands_here))) {
        found.push_back(at_line(file, index + 1, "a system does this itself: " + line));
      }
    }
  }
  return found;
}

}  // namespace corridor::architecture
