#include "bench/runner/run_graph_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/runner/back_ends.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/graph_case_files.hpp"
#include "bench/runner/graph_of.hpp"
#include "bench/runner/graph_scores.hpp"
#include "bench/runner/overrides.hpp"
#include "bench/runner/record_graph.hpp"
#include "bench/runner/systems.hpp"
#include "bench/solve/gap_trace.hpp"
#include "bench/solve/held_poses.hpp"
#include "bench/solve/optimum.hpp"
#include "bench/solve/robust_method.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/formats/graphs/g2o_file.hpp"
#include "slam/core/rng.hpp"

namespace corridor::runner {
namespace {

using results::RunResult;
using Failure = tl::unexpected<CaseFailure>;

struct GraphCase {
  catalog::LoadedGraph data;
  std::optional<solve::Recording> recording;  // what `data` is the pose graph of
  GraphTask task;
  std::optional<double> best_chi2;  // nothing: to be found when the run is done, from the next
  std::string best_chi2_source;
  std::optional<formats::PoseGraph> own_graph =
      {};  // without noise on its start and false closures
};

// Data and task.
Result<GraphCase> load(const CaseSpec& spec, const catalog::DataDirs& dirs, GraphTask task) {
  const Result<catalog::Catalog> known = catalog::known_datasets(dirs);
  if (!known) return tl::make_unexpected(known.error());
  const bool is_of_system = is_graph_of(spec.data_source);
  auto reason = why_unfit(task, is_of_system);
  const auto back_end = find_back_end(spec.backend.value_or(""));
  if (!reason && back_end) reason = why_unfit(task, *back_end);
  if (reason) {
    return fail(ErrorCode::kInvalid, fmt::format("{}@{} {}", spec.system, spec.profile, *reason),
                spec.dataset);
  }
  if (!is_of_system) {
    auto data = catalog::load_graph(spec.data_source, dirs, *known);
    if (!data) return tl::make_unexpected(data.error());
    return GraphCase{std::move(*data), {}, std::move(task), {}, "catalogue"};
  }
  const Result<GraphOf> graph = graph_of_from(spec.data_source, *known);
  if (!graph) return tl::make_unexpected(graph.error());
  auto recorded = record_graph(*graph, dirs);
  if (!recorded) return tl::make_unexpected(recorded.error());
  solve::Recording& recording = recorded->recording;
  catalog::LoadedGraph data;
  data.name = spec.dataset;
  data.graph = formats::pose_graph_of(recording.factors(), recording.initial_values());
  if (recorded->num_dropped_factors > 0) {
    data.graph.notes.push_back(fmt::format("left out: {} factors that came after the last solution",
                                           recorded->num_dropped_factors));
  }
  return GraphCase{std::move(data), std::move(recording), std::move(task), {}, ""};
}

Result<GraphTask> task_of(const CaseSpec& spec) {
  const Result<SystemInfo> info = find_system(spec.system);
  if (!info) return tl::make_unexpected(info.error());
  if (!info->takes_graphs()) {
    return fail(ErrorCode::kInvalid, fmt::format("system {} needs a log", spec.system),
                spec.dataset, "a system that solves graphs");
  }
  return info->graph_task(spec.profile, split_overrides(spec.overrides, spec.backend).system);
}

Result<std::unique_ptr<backend::BackEnd>> make_solver(const CaseSpec& spec,
                                                      const backend::LeastSquaresParams& settings) {
  return make_back_end(spec.backend.value_or(""), settings,
                       split_overrides(spec.overrides, spec.backend).back_end);
}

void put_at(const graph::Values& values, formats::PoseGraph& graph) {
  for (formats::PoseGraph::Vertex& vertex : graph.vertices) {
    vertex.T_map_base = values.pose(vertex.id);
  }
}

void add_noise(const GraphTask& task, std::uint64_t seed, formats::PoseGraph& graph) {
  const Rng rng = Rng(seed).stream("graph start");
  const std::vector<std::uint32_t> held = solve::held_poses(graph);
  for (formats::PoseGraph::Vertex& vertex : graph.vertices) {
    if (std::find(held.begin(), held.end(), vertex.id) != held.end()) continue;
    Rng own = rng.stream(std::uint64_t{vertex.id});
    const double x_m = own.normal(0, task.start_position_sigma_m);
    const double y_m = own.normal(0, task.start_position_sigma_m);
    const double heading_rad = own.normal(0, task.start_heading_sigma_rad);
    const Pose2& at = vertex.T_map_base;
    vertex.T_map_base = Pose2(at.x_m() + x_m, at.y_m() + y_m, at.theta_rad() + heading_rad);
  }
}

// Behind the graph's own edges.
Result<void> plant_false_closures(std::uint64_t seed, GraphCase& graph_case) {
  const std::size_t num_own = graph_case.data.graph.edges.size();
  const GraphTask& task = graph_case.task;
  auto planted = solve::with_false_closures(graph_case.data.graph, task.false_closures,
                                            task.false_pairs, Rng(seed));
  if (!planted) return tl::make_unexpected(planted.error());
  graph_case.data.graph = std::move(*planted);
  graph_case.task.options.num_planted = graph_case.data.graph.edges.size() - num_own;
  return {};
}

void take_as_best(double chi2, GraphCase& graph_case) {
  if (graph_case.best_chi2) return;
  graph_case.best_chi2 = chi2;
  graph_case.best_chi2_source = "own";
}

// After the run, which is not to find the memory that this leaves.
Result<void> find_best_chi2(GraphCase& graph_case) {
  if (graph_case.best_chi2) return {};
  const Result<solve::Optimum> optimum = graph_case.recording
                                             ? solve::optimum_of(*graph_case.recording)
                                             : solve::optimum_of(*graph_case.own_graph);
  if (!optimum) return tl::make_unexpected(optimum.error());
  take_as_best(optimum->chi2, graph_case);
  return {};
}

Result<void> start_at_optimum(GraphCase& graph_case) {
  const Result<solve::Optimum> optimum = solve::optimum_of(graph_case.data.graph);
  if (!optimum) return tl::make_unexpected(optimum.error());
  put_at(optimum->values, graph_case.data.graph);
  take_as_best(optimum->chi2, graph_case);
  return {};
}

// Everything that is done before the clock runs.
Result<GraphCase> prepare(const CaseSpec& spec, const catalog::DataDirs& dirs) {
  Result<GraphTask> task = task_of(spec);
  if (!task) return tl::make_unexpected(task.error());
  Result<GraphCase> loaded = load(spec, dirs, std::move(*task));
  if (!loaded) return loaded;
  GraphCase& made = *loaded;
  made.best_chi2 = made.data.best_chi2;
  if (made.task.starts_at_optimum) {
    if (const auto done = start_at_optimum(made); !done) return tl::make_unexpected(done.error());
  }
  if (!made.best_chi2 && !made.recording) made.own_graph = made.data.graph;
  if (made.task.false_closures > 0) {
    if (const auto done = plant_false_closures(spec.system_seed, made); !done) {
      return tl::make_unexpected(done.error());
    }
  }
  made.task.options.make_back_end = [spec, settings = made.task.settings] {
    return *make_solver(spec, solve::round_settings(settings));
  };
  if (made.task.has_start_noise()) add_noise(made.task, spec.system_seed, made.data.graph);
  return loaded;
}

Result<solve::SolveRun> solve_with(backend::BackEnd& solver, const GraphCase& graph_case) {
  const solve::SolveOptions& options = graph_case.task.options;
  return graph_case.recording ? solve::solve_graph(*graph_case.recording, solver, options)
                              : solve::solve_graph(graph_case.data.graph, solver, options);
}

GraphSize size_of(const GraphCase& graph_case) {
  return graph_case.recording ? runner::size_of(*graph_case.recording)
                              : runner::size_of(graph_case.data.graph);
}

Poses final_poses(const GraphCase& graph_case, const solve::SolveRun& run,
                  const backend::BackEnd& solver) {
  Poses poses;
  if (!run.chi2 || !std::isfinite(*run.chi2)) return poses;
  for (const formats::PoseGraph::Vertex& vertex : graph_case.data.graph.vertices) {
    poses.push_back({vertex.id, solver.estimate().pose(vertex.id)});
  }
  std::sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return poses;
}

Poses online_poses(const solve::SolveRun& run) {
  Poses poses;
  for (const formats::PoseGraph::Vertex& read : run.online) {
    if (read.T_map_base.is_finite()) poses.push_back(read);
  }
  // The calls of a system may read a pose several times: the first counts.
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  poses.erase(std::unique(poses.begin(), poses.end(),
                          [](const auto& a, const auto& b) { return a.id == b.id; }),
              poses.end());
  return poses;
}

std::string log_text(const GraphCase& graph_case, const RunResult& result) {
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.9g}", *value) : std::string("-");
  };
  std::string text = fmt::format(
      "case {}\nsystem {}@{} back-end {} seed {}\ngraph {}: {} variables, {} factors\nchi2 {}, at "
      "the "
      "start {}, best known {} ({})\n",
      result.case_id, result.system, result.profile, result.backend.value_or("-"),
      result.system_seed, result.dataset, *result.variables, *result.factors, number(result.chi2),
      number(result.chi2_initial), number(result.chi2_best), graph_case.best_chi2_source);
  for (const std::string& note : graph_case.data.graph.notes) text += "data note: " + note + "\n";
  for (const std::string& note : result.notes) text += "score note: " + note + "\n";
  text += fmt::format("status {}{}{}\n", to_text(result.status),
                      result.status_message.empty() ? "" : ": ", result.status_message);
  return text;
}

// Done after everything that is measured.
Result<std::vector<solve::Checkpoint>> traced(const CaseSpec& spec, const GraphCase& graph_case,
                                              const solve::SolveRun& run) {
  const GraphTask& task = graph_case.task;
  if (task.num_checkpoints == 0 || run.updates.empty()) return std::vector<solve::Checkpoint>();
  const auto solver = make_solver(spec, task.settings);
  if (!solver) return tl::make_unexpected(solver.error());
  const auto num_checkpoints = static_cast<std::size_t>(task.num_checkpoints);
  return graph_case.recording ? solve::trace_gap(*graph_case.recording, **solver, task.options,
                                                 run.updates.size(), num_checkpoints)
                              : solve::trace_gap(graph_case.data.graph, **solver, task.options,
                                                 run.updates.size(), num_checkpoints);
}

}  // namespace

tl::expected<RunResult, CaseFailure> run_graph_case(const CaseSpec& spec,
                                                    const catalog::DataDirs& dirs,
                                                    const std::filesystem::path& out,
                                                    std::optional<int> jobs) {
  Result<GraphCase> graph_case = prepare(spec, dirs);
  if (!graph_case) return Failure(CaseFailure{graph_case.error()});
  const auto solver = make_solver(spec, graph_case->task.settings);
  if (!solver) return Failure(CaseFailure{solver.error()});

  const formats::PoseGraph& graph = graph_case->data.graph;
  const Result<solve::SolveRun> run = solve_with(**solver, *graph_case);
  if (!run) return Failure(CaseFailure{run.error()});
  const Result<std::vector<solve::Checkpoint>> checkpoints = traced(spec, *graph_case, *run);
  if (!checkpoints) return Failure(CaseFailure{checkpoints.error()});
  const Result<void> best = find_best_chi2(*graph_case);
  if (!best) return Failure(CaseFailure{best.error()});

  RunResult result = record_of(spec, jobs);
  const Poses final = final_poses(*graph_case, *run, **solver);
  const Poses online = online_poses(*run);
  result.chi2_best = graph_case->best_chi2;
  result.chi2_best_source = graph_case->best_chi2_source;
  const GraphSize size = size_of(*graph_case);
  score_solution(size, *run, result);
  score_rejection(graph, graph_case->task.options, *run, result);
  score_poses(size, graph_case->data.true_poses, final, online, result);
  score_times(graph_case->task.options.mode, *run, result);
  score_trace(*checkpoints, result);
  settle_status(size, graph_case->task.options.mode, *run, result);

  const Result<void> written = write_folder_atomically(
      case_folder(out, result.case_id), [&](const std::filesystem::path& folder) -> Result<void> {
        auto done = write_graph_output(folder, {&graph, &*run, &final, &online, &*checkpoints});
        if (!done) return done;
        return write_record(folder, spec, result, log_text(*graph_case, result));
      });
  if (!written) return Failure(CaseFailure{written.error(), true});
  return result;
}

}  // namespace corridor::runner
