// Where the time of a run went, from its stage clock, as percentiles that were really measured.
#pragma once

#include <span>

#include "bench/results/run_result.hpp"
#include "bench/runner/drive.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::runner {

// Percentiles of samples of a stage; requires at least one.
results::StageTimes stage_times(Stage stage, std::span<const double> samples_s);

// Fills step_p50_us to step_max_us; null without samples.
void score_steps(std::span<const double> samples_s, results::RunResult& result);

// Fills stages, step_*, wall_s, cpu_s, peak_*_mib and realtime_factor. The step_* times are those
// of the steps that took a scan: with all the cheap inertial samples counted in, no percentile
// would show a scan. Stages that were never entered are left out.
void score_cost(const Drive& run, const StageClock& clock, double log_duration_s,
                results::RunResult& result);

}  // namespace corridor::runner
