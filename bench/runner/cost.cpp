#include "bench/runner/cost.hpp"

#include <numeric>
#include <optional>
#include <span>

#include "bench/statistics/quantiles.hpp"

namespace corridor::runner {
namespace {

constexpr double kMicroseconds = 1e6;
constexpr double kMedian = 50, k95 = 95, k99 = 99, kLargest = 100;

std::optional<double> percentile_us(std::span<const double> samples_s, double percent) {
  std::optional<double> value_s = statistics::percentile(samples_s, percent);
  if (value_s) *value_s *= kMicroseconds;
  return value_s;
}

}  // namespace

results::StageTimes stage_times(Stage stage, std::span<const double> samples_s) {
  results::StageTimes times;
  times.name = std::string(kStageNames[static_cast<std::size_t>(stage)]);
  times.count = static_cast<std::int64_t>(samples_s.size());
  times.total_s = std::accumulate(samples_s.begin(), samples_s.end(), 0.0);
  times.p50_us = percentile_us(samples_s, kMedian).value_or(0);
  times.p95_us = percentile_us(samples_s, k95).value_or(0);
  times.p99_us = percentile_us(samples_s, k99).value_or(0);
  times.max_us = percentile_us(samples_s, kLargest).value_or(0);
  return times;
}

void score_steps(std::span<const double> samples_s, results::RunResult& result) {
  result.step_p50_us = percentile_us(samples_s, kMedian);
  result.step_p95_us = percentile_us(samples_s, k95);
  result.step_p99_us = percentile_us(samples_s, k99);
  result.step_max_us = percentile_us(samples_s, kLargest);
}

void score_cost(const Drive& run, const StageClock& clock, double log_duration_s,
                results::RunResult& result) {
  result.stages.clear();
  for (std::size_t i = 0; i < kNumStages; ++i) {
    const auto stage = static_cast<Stage>(i);
    const std::vector<double>& samples_s = clock.samples_s(stage);
    if (!samples_s.empty()) result.stages.push_back(stage_times(stage, samples_s));
  }
  score_steps(run.scan_steps_s, result);
  result.wall_s = run.wall_s;
  result.cpu_s = run.cpu_s;
  result.peak_rss_mib = run.peak_rss_mib;
  result.peak_growth_mib = run.peak_growth_mib;
  if (run.wall_s > 0) result.realtime_factor = log_duration_s / run.wall_s;
}

}  // namespace corridor::runner
