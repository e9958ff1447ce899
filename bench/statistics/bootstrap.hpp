// Percentile bootstrap intervals [Efron1993, section 13.3] of the median and of any other
// statistic. It does not correct for bias or skewness (no BCa): for the medians of 5 to 50 runs
// that reports show, the percentile interval is defined for every sample and easy to check.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "bench/statistics/estimate.hpp"

namespace corridor::statistics {

struct BootstrapOptions {
  int num_resamples = 10'000;
  double confidence = 0.95;  // in (0, 1)
  std::uint64_t seed = 1;    // same seed, same bytes
};

using Statistic = std::function<double(std::span<const double>)>;

// value = statistic(values). low and high: with m resamples drawn with replacement, the
// nearest-rank percentiles (1 - confidence) / 2 and (1 + confidence) / 2 of the statistic over the
// resamples. nullopt for an empty sample, a value that is not finite, num_resamples < 1, confidence
// outside (0, 1) or a statistic that gives a NaN.
std::optional<Estimate> bootstrap_interval(std::span<const double> values,
                                           const Statistic& statistic,
                                           const BootstrapOptions& options = {});

std::optional<Estimate> bootstrap_median(std::span<const double> values,
                                         const BootstrapOptions& options = {});

}  // namespace corridor::statistics
