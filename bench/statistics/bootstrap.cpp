#include "bench/statistics/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/statistics/quantiles.hpp"
#include "slam/core/rng.hpp"

namespace corridor::statistics {
namespace {

bool are_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

std::vector<double> resampled_statistics(std::span<const double> values, const Statistic& statistic,
                                         const BootstrapOptions& options) {
  Rng rng = Rng(options.seed).stream("bootstrap");
  std::vector<double> resample(values.size());
  std::vector<double> statistics(static_cast<std::size_t>(options.num_resamples));
  for (double& result : statistics) {
    for (double& drawn : resample) drawn = values[rng.below(values.size())];
    result = statistic(resample);
  }
  return statistics;
}

}  // namespace

std::optional<Estimate> bootstrap_interval(std::span<const double> values,
                                           const Statistic& statistic,
                                           const BootstrapOptions& options) {
  const bool is_valid = !values.empty() && are_finite(values) && options.num_resamples >= 1 &&
                        options.confidence > 0 && options.confidence < 1;
  if (!is_valid) return std::nullopt;
  const double value = statistic(values);
  const auto statistics = resampled_statistics(values, statistic, options);
  const auto low = percentile(statistics, 50 * (1 - options.confidence));
  const auto high = percentile(statistics, 50 * (1 + options.confidence));
  if (std::isnan(value) || !low || !high) return std::nullopt;
  return Estimate{value, *low, *high, options.confidence, values.size()};
}

std::optional<Estimate> bootstrap_median(std::span<const double> values,
                                         const BootstrapOptions& options) {
  // Samples are finite and not empty when the statistic is called.
  return bootstrap_interval(
      values, [](std::span<const double> sample) { return median(sample).value_or(0); }, options);
}

}  // namespace corridor::statistics
