// From cases to numbers: one value per world, the median over worlds with its interval, and which
// differences between systems are real.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/statistics/estimate.hpp"
#include "reports/cases.hpp"
#include "reports/tables/table.hpp"

namespace corridor::tables {

// Fewer values than this give no interval and decide nothing: below six, even the range from the
// smallest to the largest value covers the median with less than 95 % (1 - 2 * 0.5^n).
inline constexpr int kMinValuesForInterval = 6;

// One number of a RunResult.
struct Metric {
  std::string key;   // with its unit, as in result.json
  std::string name;  // for people
  std::string unit;
  int decimals = 3;
  std::function<std::optional<double>(const results::RunResult&)> value;
  int digits_min = 0;  // significant digits of a median, whatever `decimals` says; 0: as it says
  int digits_max = 0;  // 0: all that `decimals` leaves
};

// Decimals that show a value with the metric's digits; negative ones round to tens, hundreds, ...
int decimals_for(const Metric& metric, double value);

using WorldValues = std::map<reports::World, double>;

// One value per world: the median where a world was run with several system seeds. A partial run
// gives none, because a run that tracked only its first tenth would score best; nor does a value
// that is not finite.
WorldValues world_values(const reports::Cases& cases, const std::string& dataset,
                         const reports::Series& series, const Metric& metric);
// Median over the worlds of a data set of a number that is the same for every system, with its
// interval; Missing where no case has it.
Cell summarise_worlds(const reports::Cases& cases, const std::string& dataset,
                      const Metric& metric);
// Number of worlds in which the series was tried on the data set.
int num_worlds(const reports::Cases& cases, const std::string& dataset,
               const reports::Series& series);
// Of these, those in which every case ended with status ok.
int num_ok_worlds(const reports::Cases& cases, const std::string& dataset,
                  const reports::Series& series);

// Whether any case of a data set has an error against true poses or relations: without one nobody
// knows whether a system that ended with status ok was right.
bool is_scored(const reports::Cases& cases, const std::string& dataset);
bool is_simulated(const reports::Cases& cases, const std::string& dataset);

// The Estimate of world_values, without an interval where one run was repeated, or Missing "REASON
// (0/10)"; Missing "not run" without cases.
Cell summarise(const reports::Cases& cases, const std::string& dataset,
               const reports::Series& series, const Metric& metric,
               const std::string& reason = "not measured");
std::optional<double> worst(const WorldValues& values);

// candidate / baseline over the worlds that both have values > 0 for, as median with interval;
// nullopt below kMinValuesForInterval such worlds.
std::optional<statistics::Estimate> compare_worlds(const WorldValues& baseline,
                                                   const WorldValues& candidate);

// Index of the series whose value is smaller than every other's: the paired ratio to each is below
// 1 with its whole interval, and it gave a value in at least as many worlds as each. nullopt if
// none is, or if there is nobody to compare with.
std::optional<std::size_t> clearly_smallest(const std::vector<WorldValues>& values);

}  // namespace corridor::tables
