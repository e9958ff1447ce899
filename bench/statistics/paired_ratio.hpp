// By which factor a candidate differs from a baseline, from paired runs (same world, same seed).
// It does not decide whether the factor matters: that needs a threshold, which is the reader's.
#pragma once

#include <optional>
#include <span>

#include "bench/statistics/bootstrap.hpp"
#include "bench/statistics/estimate.hpp"

namespace corridor::statistics {

// exp of the median of ln(candidate_i / baseline_i), with the bootstrap interval of that median:
// 0.5 = the candidate needs half. The logarithm makes the ratio and its inverse equally far from 1.
// nullopt unless both have the same number (> 0) of values, all of them finite and > 0.
std::optional<Estimate> paired_ratio(std::span<const double> baseline,
                                     std::span<const double> candidate,
                                     const BootstrapOptions& options = {});

}  // namespace corridor::statistics
