#include "datasets/simulation/toml_input.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/toml_text.hpp"
#include "slam/core/expect.hpp"

namespace corridor::simulation {
namespace {

// A drawing of a hundred thousand walls has half of it.
constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 24;

}  // namespace

Result<toml::table> parse_toml(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return fail(ErrorCode::kNotFound, "no such file", path.string(), "a TOML file");
  }
  const Result<std::string> text = formats::read_file_bytes(path, kMaxTomlBytes);
  if (!text) return tl::make_unexpected(text.error());
  return formats::parse_toml_text(*text, path.string());
}

Error to_error(const std::filesystem::path& path, const std::vector<TomlProblem>& problems) {
  CORRIDOR_EXPECT(!problems.empty());
  const auto place = [&](const TomlProblem& problem) {
    return problem.line == 0 ? path.string() : fmt::format("{}:{}", path.string(), problem.line);
  };
  Error error{ErrorCode::kInvalid, problems.front().text, place(problems.front()), {}};
  for (std::size_t i = 1; i < problems.size(); ++i) {
    error.what += fmt::format("; {}: {}", place(problems[i]), problems[i].text);
  }
  return error;
}

std::uint32_t line_of(const toml::table& document, std::string_view section, std::string_view key) {
  const toml::node* section_node = document.get(section);
  if (section_node == nullptr) return 0;
  const toml::table* table = section_node->as_table();
  const toml::node* node = table == nullptr ? nullptr : table->get(key);
  return (node == nullptr ? section_node : node)->source().begin.line;
}

void find_unknown_keys(const toml::table& table, std::string_view section,
                       const std::vector<std::string>& known, std::vector<TomlProblem>& problems) {
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    const std::string prefix = section.empty() ? "" : fmt::format("{}.", section);
    problems.push_back(
        {key.source().begin.line, fmt::format("unknown key {}{}; expected one of {}", prefix,
                                              key.str(), fmt::join(known, " "))});
  }
}

Eigen::Vector2d read_point(const toml::node& node, std::string_view key,
                           std::vector<TomlProblem>& problems) {
  const toml::array* pair = node.as_array();
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  if (pair == nullptr || pair->size() != 2 || !read_value(*pair->get(0), point_m.x()) ||
      !read_value(*pair->get(1), point_m.y())) {
    problems.push_back(
        {node.source().begin.line, fmt::format("{}: expected a point, [x, y]", key)});
    return Eigen::Vector2d::Zero();
  }
  return point_m;
}

std::vector<Eigen::Vector2d> read_points(const toml::node& node, std::string_view key,
                                         std::vector<TomlProblem>& problems) {
  std::vector<Eigen::Vector2d> points_m;
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    problems.push_back({node.source().begin.line,
                        fmt::format("{}: expected a list of points, [[x, y], ...]", key)});
    return points_m;
  }
  for (const toml::node& point : *list) points_m.push_back(read_point(point, key, problems));
  return points_m;
}

}  // namespace corridor::simulation
