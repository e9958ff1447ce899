// A sensor's slowly changing bias in Allan-variance figures [IEEE952]: bias instability (flicker
// noise) as a sum of first-order Gauss-Markov processes, and a random walk.
#pragma once

#include <array>
#include <cstddef>

#include "slam/core/rng.hpp"

namespace corridor::simulation {

class BiasDrift {
 public:
  // instability: B, in the sensor's unit; the Allan deviation is 0.664 B (= B sqrt(2 ln 2 / pi))
  // within a tenth for averaging times from 0.5 s to 500 s. walk: K, unit per root second.
  BiasDrift(double instability, double walk, double step_s, Rng rng);

  // The bias one step later.
  double advance();

 private:
  // Time constants of 0.1 s times powers of kRatio; each process has the variance B^2 ln(kRatio) /
  // pi, which makes their spectra add up to B^2 / (2 pi f).
  static constexpr std::size_t kNumProcesses = 9;
  static constexpr double kRatio = 4;
  static constexpr double kShortest_s = 0.1;

  double sigma_;  // of each process
  double walk_per_step_;
  std::array<double, kNumProcesses> decay_{};  // over one step
  std::array<double, kNumProcesses> states_{};
  double walked_ = 0;
  Rng rng_;
};

}  // namespace corridor::simulation
