#include "datasets/simulation/bias_drift.hpp"

#include <cmath>
#include <numbers>

namespace corridor::simulation {

BiasDrift::BiasDrift(double instability, double walk, double step_s, Rng rng)
    : sigma_(instability * std::sqrt(std::log(kRatio) / std::numbers::pi)),
      walk_per_step_(walk * std::sqrt(step_s)),
      rng_(rng) {
  double time_constant_s = kShortest_s;
  for (std::size_t i = 0; i < kNumProcesses; ++i) {
    decay_[i] = std::exp(-step_s / time_constant_s);
    states_[i] = rng_.normal(0, sigma_);  // as if it had run for ever
    time_constant_s *= kRatio;
  }
}

double BiasDrift::advance() {
  if (sigma_ == 0 && walk_per_step_ == 0) return 0;
  double bias = 0;
  for (std::size_t i = 0; i < kNumProcesses; ++i) {
    const double driven = sigma_ * std::sqrt(1 - decay_[i] * decay_[i]);
    states_[i] = decay_[i] * states_[i] + rng_.normal(0, driven);
    bias += states_[i];
  }
  walked_ += rng_.normal(0, walk_per_step_);
  return bias + walked_;
}

}  // namespace corridor::simulation
