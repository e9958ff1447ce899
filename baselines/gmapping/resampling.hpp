// Weights of the particles and their resampling [Grisetti2007] section IV-B.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace corridor::gmapping {

// w_i = exp((l_i - max l) / (weight_gain * N)), scaled to sum 1. The gain stands in for the
// dependence between beams; as in the original it grows with the number of particles. Requires at
// least one log weight, all finite.
std::vector<double> normalised_weights(std::span<const double> log_weights, double weight_gain);

// 1 / sum of w_i^2: N for equal weights, 1 for a single surviving one [Grisetti2007] eq. 20.
double effective_sample_size(std::span<const double> normalised_weights);

// Systematic resampling: N targets a step of sum/N apart, the first at `start` of a step, 0 <=
// start < 1. Returns the N chosen indices in ascending order; index i is chosen floor or ceil of N
// w_i times.
std::vector<std::size_t> systematic_resample(std::span<const double> weights, double start);

}  // namespace corridor::gmapping
