#include "datasets/formats/toml_problems.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "slam/core/expect.hpp"

namespace corridor::formats {
namespace {

std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or a time";
  }
}

}  // namespace

Error to_error(const std::string& where, const std::vector<TomlProblem>& problems) {
  CORRIDOR_EXPECT(!problems.empty());
  const auto place = [&](const TomlProblem& problem) {
    return problem.line == 0 ? where : fmt::format("{}:{}", where, problem.line);
  };
  Error error{ErrorCode::kInvalid, problems.front().text, place(problems.front()), {}};
  for (std::size_t i = 1; i < problems.size(); ++i) {
    error.what += fmt::format("; {}: {}", place(problems[i]), problems[i].text);
  }
  return error;
}

std::string path_of(std::string_view section, std::string_view key) {
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

std::uint32_t line_of(const toml::table& document, std::string_view section, std::string_view key) {
  const toml::node* section_node = document.get(section);
  if (section_node == nullptr) return 0;
  const toml::table* table = section_node->as_table();
  const toml::node* node = table == nullptr ? nullptr : table->get(key);
  return (node == nullptr ? section_node : node)->source().begin.line;
}

std::uint32_t line_of_violation(const toml::table& document, std::string_view violation) {
  const std::size_t point = violation.find('.');
  const std::size_t space = violation.find_first_of(" :");
  if (point == std::string_view::npos || space == std::string_view::npos || point > space) {
    return 0;
  }
  return line_of(document, violation.substr(0, point),
                 violation.substr(point + 1, space - point - 1));
}

void find_unknown_keys(const toml::table& table, std::string_view section,
                       const std::vector<std::string>& known, std::vector<TomlProblem>& problems) {
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    problems.push_back(
        {key.source().begin.line, fmt::format("unknown key {}; expected one of {}",
                                              path_of(section, key.str()), fmt::join(known, " "))});
  }
}

TomlProblem wrong_type(const toml::node& node, std::string_view path, std::string_view expected) {
  return {node.source().begin.line,
          fmt::format("{} is {}; expected {}", path, kind_of(node), expected)};
}

TomlProblem out_of_range(const toml::node& node, std::string_view path, std::string_view expected) {
  return {node.source().begin.line, fmt::format("{} is out of range; expected {}", path, expected)};
}

TomlProblem no_table(const toml::node& node, std::string_view path) {
  return {node.source().begin.line, fmt::format("{} is not a table; expected one", path)};
}

}  // namespace corridor::formats
