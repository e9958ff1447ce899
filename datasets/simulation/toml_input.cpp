#include "datasets/simulation/toml_input.hpp"

#include <fmt/format.h>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/toml_text.hpp"

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
