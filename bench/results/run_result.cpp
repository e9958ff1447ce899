#include "bench/results/run_result.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace corridor::results {
namespace {

constexpr std::array<std::pair<CaseStatus, std::string_view>, 7> kStatusTexts = {{
    {CaseStatus::kOk, "ok"},
    {CaseStatus::kPartial, "partial"},
    {CaseStatus::kDiverged, "diverged"},
    {CaseStatus::kFailed, "failed"},
    {CaseStatus::kTimeout, "timeout"},
    {CaseStatus::kOutOfMemory, "out_of_memory"},
    {CaseStatus::kBadInput, "bad_input"},
}};

}  // namespace

std::string to_text(CaseStatus status) {
  for (const auto& [value, text] : kStatusTexts) {
    if (value == status) return std::string(text);
  }
  return "failed";
}

std::optional<CaseStatus> case_status_from_text(const std::string& text) {
  for (const auto& [value, known] : kStatusTexts) {
    if (known == text) return value;
  }
  return std::nullopt;
}

}  // namespace corridor::results
