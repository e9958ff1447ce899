#include "bench/cli/solve_answer.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "bench/cli/solve_closures.hpp"
#include "bench/cli/solve_request.hpp"
#include "bench/statistics/quantiles.hpp"

namespace corridor::cli {
namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json update_times(const solve::SolveRun& run) {
  if (run.updates_s.empty()) return nullptr;
  constexpr double kMilliseconds = 1e3;
  const auto& times = run.updates_s;
  const auto percentile_ms = [&](double percent) {
    return kMilliseconds * statistics::percentile(times, percent).value_or(0);
  };
  const double sum_s = std::accumulate(times.begin(), times.end(), 0.0);
  Json json;
  json["mean"] = kMilliseconds * sum_s / static_cast<double>(times.size());
  json["p50"] = percentile_ms(50);
  json["p95"] = percentile_ms(95);
  json["p99"] = percentile_ms(99);
  json["max"] = percentile_ms(100);
  return json;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{:.9g}", value.get<double>()) : value.dump();
}

}  // namespace

Json to_json(const SolveCommand& command, const ParamValues& parameters,
             const ParamValues& overrides, const formats::PoseGraph& graph,
             const solve::SolveOptions& options, const solve::SolveRun& run) {
  const bool has_kernel = options.kernel.kind != graph::KernelKind::kNone;
  Json json;
  json["graph"] = command.graph;
  json["backend"] = command.back_end;
  const auto linear = parameters.find("linear");
  json["linear"] = linear == parameters.end() ? Json() : Json(linear->second);
  json["mode"] = command.mode;
  json["init"] = is_incremental(command) ? Json() : Json(command.init.value_or("file"));
  json["robust"] = command.robust;
  json["width"] = has_kernel ? Json(options.kernel.width) : Json();
  json["every"] = is_incremental(command) ? Json(options.poses_per_update) : Json();
  json["converge"] = is_incremental(command) ? Json(command.do_converge) : Json();
  json["parameters"] = parameters;
  json["set"] = overrides.empty() ? Json() : Json(overrides);
  json["poses"] = graph.vertices.size();
  json["edges"] = graph.edges.size();
  // An update promises no convergence.
  const bool is_update =
      is_incremental(command) && !command.do_converge && !backend::has_failed(run.status);
  json["status"] = is_update ? "updated" : backend::to_text(run.status);
  json["status_message"] = is_update ? "" : run.status_message;
  json["notes"] = graph.notes;
  for (const std::string& note : run.notes) json["notes"].push_back(note);
  json["iterations"] = run.num_iterations;
  json["dropped_edges"] = command.back_end == "fixed-lag" ? Json(run.num_dropped) : Json();
  json["relinearized"] = run.num_relinearized;
  json["eliminated"] = run.num_eliminated;
  json["factor_nonzeros"] = run.num_factor_nonzeros > 0 ? Json(run.num_factor_nonzeros) : Json();
  json["chi2"] = or_null(run.chi2);
  json["chi2_initial"] = or_null(run.chi2_initial);
  json["cost"] = or_null(run.cost);
  add_rejection(graph.edges.size(), options, run, json);
  const bool is_planted = command.false_closures.has_value();
  json["false_share"] = or_null(command.false_closures);
  json["false_pairs"] = is_planted ? Json(command.false_pairs.value_or("random")) : Json();
  json["seed"] = is_planted ? Json(command.seed.value_or("1")) : Json();
  json["total_s"] = run.total_s;
  json["init_s"] = is_incremental(command) ? Json() : Json(run.init_s);
  json["converge_s"] = or_null(run.converge_s);
  json["converge_rounds"] = or_null(run.converge_rounds);
  json["cpu_s"] = run.cpu_s;
  json["peak_rss_mib"] = or_null(run.peak_rss_mib);
  json["peak_growth_mib"] = or_null(run.peak_growth_mib);
  json["update_ms"] = update_times(run);
  return json;
}

std::string to_text(const Json& run) {
  std::vector<std::vector<std::string>> rows{{"result", "value"}};
  for (const auto& item : run.items()) {
    if (item.value().is_null() || item.value() == "" || item.value().is_array()) continue;
    if (item.key() == "parameters") continue;  // many; those that were set follow
    if (!item.value().is_object()) {
      rows.push_back({item.key(), value_text(item.value())});
      continue;
    }
    for (const auto& part : item.value().items()) {
      rows.push_back({item.key() + "." + part.key(), value_text(part.value())});
    }
  }
  return text_table(rows);
}

}  // namespace corridor::cli
