#include "baselines/gmapping/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slam/core/expect.hpp"

namespace corridor::gmapping {

std::vector<double> normalised_weights(std::span<const double> log_weights, double weight_gain) {
  CORRIDOR_EXPECT(!log_weights.empty());
  const double largest = *std::max_element(log_weights.begin(), log_weights.end());
  const double scale = 1 / (weight_gain * static_cast<double>(log_weights.size()));
  std::vector<double> weights;
  weights.reserve(log_weights.size());
  for (const double log_weight : log_weights) {
    weights.push_back(std::exp((log_weight - largest) * scale));
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

double effective_sample_size(std::span<const double> normalised_weights) {
  double sum_of_squares = 0;
  for (const double weight : normalised_weights) sum_of_squares += weight * weight;
  return 1 / sum_of_squares;
}

std::vector<std::size_t> systematic_resample(std::span<const double> weights, double start) {
  CORRIDOR_EXPECT(!weights.empty() && start >= 0 && start < 1);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double step = sum / static_cast<double>(weights.size());
  std::vector<std::size_t> chosen;
  chosen.reserve(weights.size());
  double cumulative = weights[0];
  std::size_t index = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double target = step * (start + static_cast<double>(i));
    // Rounding may leave the last target above the total: the last particle takes it.
    while (target >= cumulative && index + 1 < weights.size()) cumulative += weights[++index];
    chosen.push_back(index);
  }
  return chosen;
}

}  // namespace corridor::gmapping
