#include "bench/runner/detection.hpp"

#include <optional>
#include <vector>

namespace corridor::runner {
namespace {

struct Interval {
  double begin_s = 0;
  double end_s = 0;
};

// One scan at which the flag was given: what was said and what is true.
struct Judged {
  double stamp_s = 0;
  bool is_alarm = false;
  bool is_true = false;
};

std::vector<Judged> judge(std::span<const HealthSample> health,
                          std::optional<bool> HealthSample::*flag,
                          std::span<const Interval> intervals) {
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < health.size(); ++i) {
    if (!(health[i].*flag)) continue;
    const double end_s = to_seconds(health[i].stamp);
    const double begin_s = i == 0 ? end_s : to_seconds(health[i - 1].stamp);
    bool is_true = false;
    for (const Interval& interval : intervals) {
      is_true = is_true || (interval.begin_s <= end_s && interval.end_s >= begin_s);
    }
    judged.push_back({end_s, *(health[i].*flag), is_true});
  }
  return judged;
}

struct Rates {
  std::optional<double> precision, recall;
};

Rates rates(std::span<const Judged> judged) {
  double num_alarms = 0;
  double num_affected = 0;
  double num_both = 0;
  for (const Judged& scan : judged) {
    num_alarms += scan.is_alarm ? 1 : 0;
    num_affected += scan.is_true ? 1 : 0;
    num_both += scan.is_alarm && scan.is_true ? 1 : 0;
  }
  Rates found;
  if (num_alarms > 0) found.precision = num_both / num_alarms;
  if (num_affected > 0) found.recall = num_both / num_affected;
  return found;
}

std::optional<double> mean_latency_s(std::span<const Judged> judged,
                                     std::span<const Interval> intervals) {
  double sum_s = 0;
  int num_noticed = 0;
  for (const Interval& interval : intervals) {
    for (const Judged& scan : judged) {
      if (scan.is_alarm && scan.stamp_s >= interval.begin_s && scan.stamp_s <= interval.end_s) {
        sum_s += scan.stamp_s - interval.begin_s;
        ++num_noticed;
        break;
      }
    }
  }
  if (num_noticed == 0) return std::nullopt;
  return sum_s / num_noticed;
}

}  // namespace

void score_detection(std::span<const HealthSample> health, const simulation::SimulationTruth& truth,
                     results::RunResult& result) {
  std::vector<Interval> slips;
  for (const simulation::SlipInterval& slip : truth.slips) {
    slips.push_back({slip.begin_s, slip.end_s});
  }
  const std::vector<Judged> slip_flags = judge(health, &HealthSample::is_slip_detected, slips);
  const Rates slip_rates = rates(slip_flags);
  result.slip_precision = slip_rates.precision;
  result.slip_recall = slip_rates.recall;
  result.slip_latency_s = mean_latency_s(slip_flags, slips);

  if (!truth.degenerate) return;
  std::vector<Interval> degenerate;
  for (const simulation::DegenerateInterval& interval : *truth.degenerate) {
    degenerate.push_back({interval.begin_s, interval.end_s});
  }
  const Rates degeneracy = rates(judge(health, &HealthSample::is_degenerate, degenerate));
  result.degeneracy_precision = degeneracy.precision;
  result.degeneracy_recall = degeneracy.recall;
}

}  // namespace corridor::runner
