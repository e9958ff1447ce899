#include "bench/statistics/wilson.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::statistics {
namespace {

// Upper tail P(X > x), accurate far out because erfc is.
double upper_tail(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }

// x >= 0 with upper_tail(x) = tail, by bisection: 40 standard deviations hold every positive
// double.
double upper_tail_inverse(double tail) {
  double low = 0;
  double high = 40;
  while (true) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) return middle;
    (upper_tail(middle) > tail ? low : high) = middle;
  }
}

}  // namespace

std::optional<double> normal_quantile(double probability) {
  if (!(probability > 0 && probability < 1)) return std::nullopt;
  return probability < 0.5 ? -upper_tail_inverse(probability) : upper_tail_inverse(1 - probability);
}

std::optional<Estimate> wilson_interval(std::int64_t successes, std::int64_t trials,
                                        double confidence) {
  const bool is_valid =
      successes >= 0 && trials > 0 && successes <= trials && confidence > 0 && confidence < 1;
  if (!is_valid) return std::nullopt;
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n;
  const double z = *normal_quantile((1 + confidence) / 2);
  const double denominator = 1 + z * z / n;
  const double centre = (p + z * z / (2 * n)) / denominator;
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / denominator;
  // At 0 of n and n of n one end is p itself; rounding must not push it past p.
  return Estimate{p, std::clamp(centre - half, 0.0, p), std::clamp(centre + half, p, 1.0),
                  confidence, static_cast<std::size_t>(trials)};
}

}  // namespace corridor::statistics
