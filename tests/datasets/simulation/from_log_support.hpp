// What the tests of each error share that find it as a user would: in a log that was simulated,
// written to a file and read back.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/truth.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::simulation::testing {

struct RecordedRun {
  SensorLog log;
  SimulationTruth truth;
};
// Simulated, written as LOG.rawlog with its sidecars, read back.
RecordedRun recorded(const Scenario& scenario, std::uint64_t seed);

// A hall of 60 m x 12 m in which a robot drives 50 m along +x at 1 m/s, with ticks of a micrometre;
// nothing is drawn and nothing is noisy. A LiDAR of four beams gives the truth's stamps.
Scenario honest_scenario();
// The same robot stands for so long, then turns so often on the spot at up to 2 rad/s.
Scenario honest_stay(double stand_s, double spin_turns = 0);

template <class T>
std::vector<T> readings(const SensorLog& log) {
  std::vector<T> found;
  for (const SensorEvent& event : log.events) {
    if (const auto* reading = std::get_if<T>(&event)) found.push_back(*reading);
  }
  return found;
}

// Something that a seed draws once per log, and how to find it in that log.
struct DrawnValue {
  std::string name;
  std::function<double(const RecordedRun&)> found;
  double mean = 0, sigma = 0;
};
// Over 800 logs: mean and standard deviation of each value within four standard errors of the
// stated ones, which are a tenth of the standard deviation: one that is 15 % off fails. The values
// must be told apart in one and the same log.
void expect_spreads(const Scenario& scenario, const std::vector<DrawnValue>& values);

// Standard deviation of a uniform number between -half_range and half_range.
double uniform_sigma(double half_range);
// Parts of a value that four standard errors of a standard deviation from n samples make out.
double four_sigma(double num_samples);

// The path that the wheels have counted, in ticks of honest_scenario().
struct Counted {
  std::vector<double> stamps_s, common_m, difference_m;  // (left + right) / 2, right - left
};
Counted counted(const RecordedRun& run);
// Between the first scan and the last: way along +x, heading over any number of turns.
double driven_m(const RecordedRun& run);
double turned_rad(const RecordedRun& run);
// Change of a counted column between the first scan and the last, whose stamps are the wheels' too.
double counted_between_scans_m(const RecordedRun& run, const std::vector<double>& column_m);

}  // namespace corridor::simulation::testing
