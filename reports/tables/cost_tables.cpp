// Where time and memory went.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "bench/statistics/quantiles.hpp"
#include "reports/metrics.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"
#include "reports/timing.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::RunResult;
using results::StageTimes;

// Significant digits at least: a time of 0.04 us is not 0.0.
constexpr int kTimeDigits = 2;

std::vector<Metric> cost_metrics() {
  return {{"step_p50_us", "step p50 [us]", "us", 1,
           [](const RunResult& r) { return r.step_p50_us; }, kTimeDigits},
          {"step_p95_us", "step p95 [us]", "us", 1,
           [](const RunResult& r) { return r.step_p95_us; }, kTimeDigits},
          {"step_p99_us", "step p99 [us]", "us", 1,
           [](const RunResult& r) { return r.step_p99_us; }, kTimeDigits},
          {"step_max_us", "step max [us]", "us", 1,
           [](const RunResult& r) { return r.step_max_us; }, kTimeDigits},
          {"wall_s", "wall [s]", "s", 2, [](const RunResult& r) { return r.wall_s; }, kTimeDigits},
          {"cpu_s", "CPU [s]", "s", 2, [](const RunResult& r) { return r.cpu_s; }, kTimeDigits},
          reports::realtime_factor(),
          {"peak_rss_mib", "peak memory [MiB]", "MiB", 0,
           [](const RunResult& r) { return r.peak_rss_mib; }}};
}

const StageTimes* find_stage(const RunResult& result, std::string_view name) {
  for (const StageTimes& stage : result.stages) {
    if (stage.name == name) return &stage;
  }
  return nullptr;
}

struct StageField {
  const char* heading;
  const char* key;
  int decimals;
  double (*value)(const StageTimes&);
};

constexpr std::array kStageFields = {
    StageField{"total [s]", "total_s", 3, [](const StageTimes& s) { return s.total_s; }},
    StageField{"p50 [us]", "p50_us", 1, [](const StageTimes& s) { return s.p50_us; }},
    StageField{"p95 [us]", "p95_us", 1, [](const StageTimes& s) { return s.p95_us; }},
    StageField{"p99 [us]", "p99_us", 1, [](const StageTimes& s) { return s.p99_us; }},
    StageField{"max [us]", "max_us", 1, [](const StageTimes& s) { return s.max_us; }}};

Metric stage_metric(std::string_view stage_name, const StageField& field) {
  return {field.key,
          field.heading,
          "",
          field.decimals,
          [name = std::string(stage_name),
           value = field.value](const RunResult& result) -> std::optional<double> {
            const StageTimes* stage = find_stage(result, name);
            if (stage == nullptr) return std::nullopt;
            return value(*stage);
          },
          kTimeDigits};
}

bool has_stage(const Cases& cases, const std::string& dataset, const Series& series,
               std::string_view name) {
  const std::vector<const Case*> tried = cases.of(dataset, series);
  return std::any_of(tried.begin(), tried.end(), [&](const Case* entry) {
    const StageTimes* stage = find_stage(entry->result, name);
    return stage != nullptr && stage->count > 0;
  });
}

}  // namespace

Table cost_table(const Cases& cases) {
  Table table;
  table.id = "cost";
  table.is_detail = true;
  table.caption =
      "Time and memory per run, step() and finish() only: median over worlds [95 % bootstrap "
      "interval of the median] (worlds with a value / worlds tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText}};
  for (const Metric& metric : cost_metrics()) {
    table.columns.push_back({metric.name, metric.key, ColumnKind::kEstimate});
  }
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      if (cases.of(dataset, series).empty()) continue;
      std::vector<Cell> row = {dataset, cases.label(series)};
      for (const Metric& metric : cost_metrics()) {
        row.push_back(summarise(cases, dataset, series, metric));
      }
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = reports::timing_notes(cases);
  table.notes.emplace_back(
      "p50, p95, p99 are order statistics over the steps of a run. Times of different machines are "
      "not comparable; memory is the peak of the whole process.");
  return table;
}

Table stage_table(const Cases& cases) {
  Table table;
  table.id = "stages";
  table.is_detail = true;
  table.caption =
      "Time per stage, over the steps that entered it: median over worlds [95 % bootstrap interval "
      "of the median] (worlds with a value / worlds tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"stage", "stage", ColumnKind::kText}};
  for (const StageField& field : kStageFields) {
    table.columns.push_back({field.heading, field.key, ColumnKind::kEstimate});
  }
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      for (const std::string_view stage : kStageNames) {
        if (!has_stage(cases, dataset, series, stage)) continue;
        std::vector<Cell> row = {dataset, cases.label(series), std::string(stage)};
        for (const StageField& field : kStageFields) {
          row.push_back(summarise(cases, dataset, series, stage_metric(stage, field)));
        }
        table.rows.push_back(std::move(row));
      }
    }
  }
  table.notes = reports::timing_notes(cases);
  return table;
}

}  // namespace corridor::tables
