#include "reports/graph_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::reports {
namespace {

constexpr double kMicroseconds = 1e6;
// Columns of updates.csv that are shown.
constexpr std::size_t kPoses = 2, kTime = 3, kChi2 = 7, kOptimum = 8, kNewestGap = 9,
                      kNumFields = 11;

// Empty fields are not numbers.
std::optional<std::array<std::optional<double>, kNumFields>> fields_of(std::string_view line) {
  std::array<std::optional<double>, kNumFields> fields;
  for (std::size_t i = 0; i < kNumFields; ++i) {
    const std::size_t comma = line.find(',');
    const bool is_last = i + 1 == kNumFields;
    if ((comma == std::string_view::npos) != is_last) return std::nullopt;
    const std::string_view field = line.substr(0, comma);
    fields[i] = formats::parse_double(field);
    if (!field.empty() && !fields[i]) return std::nullopt;
    line.remove_prefix(is_last ? line.size() : comma + 1);
  }
  return fields;
}

std::optional<UpdateRow> row_of(std::string_view line) {
  const auto fields = fields_of(line);
  if (!fields || !(*fields)[kPoses] || !(*fields)[kTime]) return std::nullopt;
  UpdateRow row{*(*fields)[kPoses], *(*fields)[kTime] / kMicroseconds, {}};
  const auto& chi2 = (*fields)[kChi2];
  const auto& optimum = (*fields)[kOptimum];
  const auto& gap_m = (*fields)[kNewestGap];
  if (chi2 && optimum && gap_m) row.checkpoint = {*chi2, *optimum, *gap_m};
  return row;
}

}  // namespace

double number_of(const results::RunResult& result, const std::string& parameter) {
  const auto found = result.parameters.find(parameter);
  return found == result.parameters.end() ? 0 : formats::parse_double(found->second).value_or(0);
}

bool is_drawn(const results::RunResult& result) {
  constexpr std::array kWhatIsDrawn = {"start_position_sigma_m", "start_heading_sigma_rad",
                                       "false_closures"};
  return std::any_of(kWhatIsDrawn.begin(), kWhatIsDrawn.end(),
                     [&](const char* name) { return number_of(result, name) > 0; });
}

bool is_pose_by_pose(const results::RunResult& result) { return result.step_max_us.has_value(); }

bool is_within(const results::RunResult& result, double ratio) {
  if (result.status != results::CaseStatus::kOk || !result.chi2 || !result.chi2_best) return false;
  return *result.chi2 <= *result.chi2_best * (1 + ratio) + results::kExactFit_chi2;
}

bool is_solved(const results::RunResult& result) {
  return is_within(result, is_pose_by_pose(result) ? kSolvedPoseByPose_ratio : kSolvedAtOnce_ratio);
}

Result<std::vector<UpdateRow>> read_updates(const std::filesystem::path& case_dir) {
  const std::filesystem::path path = case_dir / "updates.csv";
  const Result<std::string> bytes = formats::read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  std::string_view text = *bytes;
  std::vector<UpdateRow> rows;
  std::size_t num_lines = 0;
  while (const auto line = formats::take_line(text)) {
    if (num_lines++ == 0) continue;  // the names of the columns
    const std::optional<UpdateRow> row = row_of(*line);
    if (!row) {
      return fail(ErrorCode::kMalformed, "no line of updates.csv: " + formats::quote(*line),
                  fmt::format("{}:{}", path.string(), num_lines),
                  fmt::format("{} fields, poses and time among them", kNumFields));
    }
    rows.push_back(*row);
  }
  return rows;
}

}  // namespace corridor::reports
