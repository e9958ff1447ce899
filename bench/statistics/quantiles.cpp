#include "bench/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace corridor::statistics {
namespace {

std::optional<std::vector<double>> sorted_copy(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  if (std::any_of(values.begin(), values.end(), [](double x) { return std::isnan(x); })) {
    return std::nullopt;
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

// 95 % of 20 must be rank 19 although 0.95 * 20 is 19.000000000000004 in some orders of evaluation.
constexpr double kRankRounding = 1e-9;

std::size_t nearest_rank(double percent, std::size_t num_values) {
  const double rank = std::ceil(percent * static_cast<double>(num_values) / 100 - kRankRounding);
  return std::clamp(static_cast<std::size_t>(std::max(rank, 1.0)), std::size_t{1}, num_values);
}

}  // namespace

std::optional<double> percentile(std::span<const double> values, double percent) {
  if (!(percent >= 0 && percent <= 100)) return std::nullopt;
  const auto sorted = sorted_copy(values);
  if (!sorted) return std::nullopt;
  return (*sorted)[nearest_rank(percent, sorted->size()) - 1];
}

std::optional<double> median(std::span<const double> values) {
  const auto sorted = sorted_copy(values);
  if (!sorted) return std::nullopt;
  const std::size_t middle = sorted->size() / 2;
  const double upper = (*sorted)[middle];
  if (sorted->size() % 2 == 1) return upper;
  const double lower = (*sorted)[middle - 1];
  if (lower == upper) return upper;
  const double mean = lower / 2 + upper / 2;
  return std::isnan(mean) ? std::nullopt : std::optional(mean);
}

}  // namespace corridor::statistics
