// The examples of a document, for tests that try them as they stand.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace corridor::testing {

inline std::string text_of_document(const std::string& path_in_tree) {
  std::ifstream file(std::filesystem::path(CORRIDOR_SOURCE_DIR) / path_in_tree, std::ios::binary);
  if (!file) throw std::runtime_error("no document " + path_in_tree);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// From "## TITLE" to the next such line.
inline std::string section_of(const std::string& document, const std::string& title) {
  const std::size_t begin = document.find("\n## " + title + "\n");
  if (begin == std::string::npos) throw std::runtime_error("no section " + title);
  return document.substr(begin, document.find("\n## ", begin + 1) - begin);
}

// What stands between ```LANGUAGE and ```.
inline std::vector<std::string> examples_in(const std::string& text, const std::string& language) {
  std::vector<std::string> found;
  const std::string fence = "\n```" + language + "\n";
  for (std::size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
    at += fence.size();
    const std::size_t end = text.find("\n```", at);
    if (end == std::string::npos) throw std::runtime_error("an example without an end");
    found.push_back(text.substr(at, end + 1 - at));
  }
  return found;
}

// Of an example that says `name = "..."`.
inline std::string name_in(const std::string& toml) {
  const std::string key = "name = \"";
  const std::size_t begin = toml.find(key);
  if (begin == std::string::npos) throw std::runtime_error("an example without a name");
  const std::size_t at = begin + key.size();
  return toml.substr(at, toml.find('"', at) - at);
}

}  // namespace corridor::testing
