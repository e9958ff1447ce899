#include "datasets/formats/trajectories/relations.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/degree_check.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumFields = 8;
constexpr const char* kLayout = "'t1 t2 dx dy dz droll dpitch dyaw'";

Result<void> check_motion(const Relation& relation, double dyaw_rad, const std::string& where) {
  const double time_s = std::abs(seconds_between(relation.t1, relation.t2));
  if (relation.t1 == relation.t2) {
    return fail(ErrorCode::kInvalid, "t1 and t2 are the same time", where, "two times of the log");
  }
  if (std::abs(dyaw_rad) > kWholeTurn_rad) {
    return fail(ErrorCode::kInvalid, fmt::format("a turn of {} rad", dyaw_rad), where,
                "at most 2 pi (degrees for radians?)");
  }
  const LogLimits limits;
  const double length_m = relation.T_1_2.translation_m().norm();
  if (length_m <= limits.max_speed_mps * time_s + limits.max_jump_m) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("a motion of {:.6g} m in {:.6g} s", length_m, time_s), where,
              fmt::format("at most {} m/s (centimetres for metres?)", limits.max_speed_mps));
}

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
  const Relation relation{*t1, *t2, Pose2(dx_m, dy_m, dyaw_rad)};
  if (auto possible = check_motion(relation, dyaw_rad, where); !possible) {
    return tl::make_unexpected(possible.error());
  }
  return relation;
}

using Times = std::pair<Timestamp, Timestamp>;

Times times_of(const Relation& relation) { return {relation.t1, relation.t2}; }

}  // namespace

Result<std::vector<Relation>> read_relations(const std::filesystem::path& path) {
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  std::vector<Relation> relations;
  std::map<Times, Relation> known;
  std::string_view text = *bytes;
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    ++line_number;
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    const std::string where = fmt::format("{}:{}", path.string(), line_number);
    auto relation = parse_relation(*line, where);
    if (!relation) return tl::make_unexpected(relation.error());
    const auto [same_times, is_new] = known.try_emplace(times_of(*relation), *relation);
    if (!is_new && same_times->second != *relation) {
      return fail(ErrorCode::kInvalid, "another relation between these two times stands before",
                  where, "one, or the same again");
    }
    relations.push_back(*relation);
  }
  if (note_on_end(*bytes)) {
    return fail(ErrorCode::kMalformed, "the last line has no end",
                fmt::format("{}:{}", path.string(), line_number),
                "a line's end: without it the last number may be cut");
  }
  if (relations.empty()) {
    return fail(ErrorCode::kMalformed, "no relation in the file", path.string(),
                fmt::format("lines of {}", kLayout));
  }
  return relations;
}

std::size_t num_repeated(const std::vector<Relation>& relations) {
  std::set<Times> known;
  for (const Relation& relation : relations) known.insert(times_of(relation));
  return relations.size() - known.size();
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
