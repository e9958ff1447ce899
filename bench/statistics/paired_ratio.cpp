#include "bench/statistics/paired_ratio.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace corridor::statistics {

std::optional<Estimate> paired_ratio(std::span<const double> baseline,
                                     std::span<const double> candidate,
                                     const BootstrapOptions& options) {
  if (baseline.size() != candidate.size()) return std::nullopt;
  std::vector<double> log_ratios(baseline.size());
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    const bool is_valid = std::isfinite(baseline[i]) && std::isfinite(candidate[i]) &&
                          baseline[i] > 0 && candidate[i] > 0;
    if (!is_valid) return std::nullopt;
    // Difference of logarithms, not logarithm of the quotient, which may overflow.
    log_ratios[i] = std::log(candidate[i]) - std::log(baseline[i]);
  }
  auto estimate = bootstrap_median(log_ratios, options);
  if (!estimate) return std::nullopt;
  estimate->value = std::exp(estimate->value);
  estimate->low = std::exp(estimate->low);
  estimate->high = std::exp(estimate->high);
  return estimate;
}

}  // namespace corridor::statistics
