#include "datasets/formats/trajectories/relations.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumFields = 8;
constexpr const char* kLayout = "'t1 t2 dx dy dz droll dpitch dyaw'";

Result<Relation> parse_relation(std::string_view line, const std::string& where) {
  const auto fields = split_fields(line);
  if (fields.size() != kNumFields) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), where,
                fmt::format("8: {}", kLayout));
  }
  const auto t1 = parse_stamp(fields[0]);
  const auto t2 = parse_stamp(fields[1]);
  if (!t1 || !t2) {
    return fail(ErrorCode::kMalformed, "stamp " + quote(fields[t1 ? 1 : 0]), where,
                "decimal seconds");
  }
  std::array<double, kNumFields - 2> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = parse_double(fields[i + 2]);
    if (!number || !std::isfinite(*number)) {
      return fail(ErrorCode::kMalformed, "field " + quote(fields[i + 2]), where, "a finite number");
    }
    numbers[i] = *number;
  }
  const auto [dx_m, dy_m, dz_m, droll_rad, dpitch_rad, dyaw_rad] = numbers;
  if (dz_m != 0 || droll_rad != 0 || dpitch_rad != 0) {
    return fail(ErrorCode::kUnsupported, "a relation out of the plane", where,
                "dz = droll = dpitch = 0");
  }
  return Relation{*t1, *t2, Pose2(dx_m, dy_m, dyaw_rad)};
}

}  // namespace

Result<std::vector<Relation>> read_relations(const std::filesystem::path& path) {
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  std::vector<Relation> relations;
  std::string_view text = *bytes;
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    ++line_number;
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    auto relation = parse_relation(*line, fmt::format("{}:{}", path.string(), line_number));
    if (!relation) return tl::make_unexpected(relation.error());
    relations.push_back(*relation);
  }
  if (relations.empty()) {
    return fail(ErrorCode::kMalformed, "no relation in the file", path.string(),
                fmt::format("lines of {}", kLayout));
  }
  return relations;
}

Result<void> write_relations(const std::vector<Relation>& relations,
                             const std::filesystem::path& path) {
  std::string text = "# t1_s t2_s dx_m dy_m dz_m droll_rad dpitch_rad dyaw_rad\n";
  for (const Relation& relation : relations) {
    text +=
        fmt::format("{} {} {} {} 0 0 0 {}\n", format_stamp(relation.t1), format_stamp(relation.t2),
                    relation.T_1_2.x_m(), relation.T_1_2.y_m(), relation.T_1_2.theta_rad());
  }
  return write_file_atomically(path, text);
}

}  // namespace corridor::formats
