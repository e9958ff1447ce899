// Order statistics of a sample: nearest-rank percentiles and the median.
// Every value returned is a value that was measured, except the median of an even number of values.
// It does not interpolate percentiles and never assumes a distribution.
#pragma once

#include <optional>
#include <span>

namespace corridor::statistics {

// Nearest-rank percentile [Hyndman1996, definition 1]: the smallest value x of the sample with at
// least `percent` % of the sample <= x, that is the value of rank ceil(percent / 100 * n), and the
// minimum for percent = 0. nullopt for an empty sample, a NaN in it, or percent outside [0, 100].
// Infinite values are ordered like any other: a time-out may be +inf.
std::optional<double> percentile(std::span<const double> values, double percent);

// The middle value; the mean of the two middle ones for an even number of values (as the field's
// tables do). nullopt for an empty sample or a NaN in it, and where the two middle values are -inf
// and +inf.
std::optional<double> median(std::span<const double> values);

}  // namespace corridor::statistics
