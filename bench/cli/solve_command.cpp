#include "bench/cli/solve_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "bench/cli/solve_closures.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/overrides.hpp"
#include "bench/solve/false_closures.hpp"
#include "bench/solve/solve_graph.hpp"
#include "bench/statistics/quantiles.hpp"
#include "datasets/catalog/load_dataset.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/linear/make_linear_solver.hpp"

namespace corridor::cli {
namespace {

using Json = nlohmann::ordered_json;
using graph::KernelKind;
using linear::LinearSolverKind;

constexpr std::array kKernels = {KernelKind::kNone, KernelKind::kHuber, KernelKind::kCauchy,
                                 KernelKind::kGemanMcClure, KernelKind::kDcs};
// In the order of solve::Rejection, behind kNone.
constexpr std::array<std::string_view, 3> kRejections = {"gnc", "gnc-geman-mcclure", "pcm"};
constexpr std::array kFalsePairs = {solve::FalsePairs::kRandom, solve::FalsePairs::kLocal,
                                    solve::FalsePairs::kGrouped};
constexpr std::array kLinearSolvers = {LinearSolverKind::kCholmod, LinearSolverKind::kBlock};
// In the order of solve::Initialization.
constexpr std::array<std::string_view, 3> kInits = {"file", "odometry", "chordal"};

// Iterations of a batch solution: Levenberg-Marquardt takes many more than plain Gauss-Newton.
constexpr int kMaxIterations = 100;
// Of a round of gnc: on M3500 with 10 % false closures rounds that were solved to the end took 562
// iterations instead of 97 and kept a false one.
constexpr int kRoundIterations = 5;
constexpr double kRoundMinRelativeDecrease = 1e-3;
// A batch solution is compared with others to six digits; it stops well below.
constexpr double kMinRelativeDecrease = 1e-9;

template <class Value, std::size_t kSize>
std::vector<std::string> texts_of(const std::array<Value, kSize>& values) {
  std::vector<std::string> texts;
  for (const Value& value : values) texts.emplace_back(to_text(value));
  return texts;
}

// The value of that text, which the command line has checked.
template <class Value, std::size_t kSize>
Value from_text(const std::array<Value, kSize>& values, const std::string& text) {
  return *std::find_if(values.begin(), values.end(),
                       [&](Value value) { return to_text(value) == text; });
}

tl::unexpected<Error> not_together(const std::string& option, const std::string& why,
                                   const std::string& expected) {
  return fail(ErrorCode::kInvalid, why, option, expected);
}

// Kernels, then methods that reject edges.
std::vector<std::string> robust_methods() {
  std::vector<std::string> names = texts_of(kKernels);
  names.insert(names.end(), kRejections.begin(), kRejections.end());
  return names;
}

// What --robust names, if it is no kernel.
solve::Rejection rejection_of(const SolveCommand& command) {
  const auto found = std::find(kRejections.begin(), kRejections.end(), command.robust);
  if (found == kRejections.end()) return solve::Rejection::kNone;
  return static_cast<solve::Rejection>(found - kRejections.begin() + 1);
}

bool is_incremental(const SolveCommand& command) { return command.mode == "incremental"; }

// These solve by slam/linear; the others bring a factorisation of their own.
bool has_linear_solver(const SolveCommand& command) {
  return command.back_end == "gauss-newton" || command.back_end == "levenberg";
}

// What --set, --linear and --lag say of the back-end's parameters, each once.
Result<ParamValues> overrides_of(const SolveCommand& command) {
  ParamValues overrides;
  if (command.linear) overrides["linear"] = *command.linear;
  if (command.lag) overrides["lag"] = std::to_string(*command.lag);
  for (const std::string& text : command.overrides) {
    const Result<runner::Override> set = runner::parse_override(text);
    if (!set) return tl::make_unexpected(set.error());
    if (set->owner != command.back_end) {
      return not_together("--set", fmt::format(R"(back-end "{}" is not used)", set->owner),
                          command.back_end + ".key=value");
    }
    if (!overrides.emplace(set->key, set->value).second) {
      return not_together("--set", fmt::format("{}.{} is given twice", set->owner, set->key),
                          "each parameter once");
    }
  }
  return overrides;
}

Result<void> check_robust(const SolveCommand& command) {
  const bool is_rejection = rejection_of(command) != solve::Rejection::kNone;
  if (is_rejection && is_incremental(command)) {
    return not_together("--robust", command.robust + " looks at all edges at once",
                        "--mode batch with it, or dcs");
  }
  if (command.width && (command.robust == "none" || is_rejection)) {
    return not_together("--width", "without a kernel there is no width",
                        "--robust with a kernel with it");
  }
  if (command.robust == "none" && (command.inlier_probability || !command.rejected.empty())) {
    return not_together(command.inlier_probability ? "--inlier-probability" : "--rejected",
                        "without a robust method nothing is rejected", "--robust with it");
  }
  if (!command.false_closures && (command.seed || command.false_pairs)) {
    return not_together(command.seed ? "--seed" : "--false-pairs",
                        "without false closures nothing is drawn", "--false-closures with it");
  }
  if (command.rejected.empty()) return {};
  if (is_same_file(command.rejected, command.out) ||
      is_same_file(command.rejected, command.graph)) {
    return fail(ErrorCode::kInvalid, "this is the file of a graph", command.rejected,
                "another name for the list of rejected edges");
  }
  return check_targets({command.rejected});
}

Result<void> check_request(const SolveCommand& command) {
  if (const Result<void> known = runner::check_back_end(command.back_end); !known) {
    Error error = known.error();
    error.where = "--backend";
    return tl::make_unexpected(std::move(error));
  }
  if (command.linear && !has_linear_solver(command)) {
    return not_together("--linear", command.back_end + " has a factorisation of its own",
                        "gauss-newton or levenberg with it");
  }
  if (command.lag && command.back_end != "fixed-lag") {
    return not_together("--lag", command.back_end + " forgets no pose",
                        "--backend fixed-lag with it");
  }
  if (command.back_end == "fixed-lag" && !is_incremental(command)) {
    return not_together("--backend", "a batch solution has no window that moves along",
                        "--mode incremental with fixed-lag");
  }
  if (command.init && is_incremental(command)) {
    return not_together("--init", "poses that come one by one start at their edges",
                        "--mode batch with it");
  }
  if (command.every && !is_incremental(command)) {
    return not_together("--every", "a batch solution has no updates", "--mode incremental with it");
  }
  if (command.do_converge && !is_incremental(command)) {
    return not_together("--converge", "a batch solution goes on by itself",
                        "--mode incremental with it");
  }
  if (const Result<void> good = check_robust(command); !good) return good;
  if (command.out.empty()) return {};
  if (!formats::graph_format_from_suffix(command.out)) {
    return fail(ErrorCode::kUnsupported, "unknown kind of graph", command.out,
                "a name that ends in .g2o, .graph or .toro");
  }
  if (is_same_file(command.graph, command.out)) {
    return fail(ErrorCode::kInvalid, "this is the file that is read", command.out, "another name");
  }
  return check_targets({command.out});
}

solve::SolveOptions options_of(const SolveCommand& command) {
  solve::SolveOptions options;
  if (is_incremental(command)) options.mode = solve::Mode::kIncremental;
  const auto init = std::find(kInits.begin(), kInits.end(), command.init.value_or("file"));
  options.init = static_cast<solve::Initialization>(init - kInits.begin());
  options.poses_per_update = command.every.value_or(1);
  options.do_converge = command.do_converge;
  options.rejection = rejection_of(command);
  if (options.rejection == solve::Rejection::kNone) {
    options.kernel.kind = from_text(kKernels, command.robust);
    options.kernel.width = command.width.value_or(1.0);
  }
  options.inlier_probability = command.inlier_probability.value_or(options.inlier_probability);
  return options;
}

backend::LeastSquaresParams default_settings() {
  backend::LeastSquaresParams settings;
  settings.max_iterations = kMaxIterations;
  settings.min_relative_decrease = kMinRelativeDecrease;
  return settings;
}

// Of the weighted solutions of gnc: the next begins where the last one ends, and what follows them
// is solved to the end.
backend::LeastSquaresParams round_settings() {
  backend::LeastSquaresParams settings = default_settings();
  settings.max_iterations = kRoundIterations;
  settings.min_relative_decrease = kRoundMinRelativeDecrease;
  return settings;
}

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

Json to_json(const SolveCommand& command, const ParamValues& overrides,
             const formats::PoseGraph& graph, const solve::SolveOptions& options,
             const solve::SolveRun& run) {
  const bool has_kernel = options.kernel.kind != KernelKind::kNone;
  Json json;
  json["graph"] = command.graph;
  json["backend"] = command.back_end;
  const auto linear = overrides.find("linear");
  json["linear"] = !has_linear_solver(command) ? Json()
                   : linear != overrides.end() ? Json(linear->second)
                                               : Json(default_settings().linear);
  json["mode"] = command.mode;
  json["init"] = is_incremental(command) ? Json() : Json(command.init.value_or("file"));
  json["robust"] = command.robust;
  json["width"] = has_kernel ? Json(options.kernel.width) : Json();
  json["every"] = is_incremental(command) ? Json(options.poses_per_update) : Json();
  json["converge"] = is_incremental(command) ? Json(command.do_converge) : Json();
  json["parameters"] = overrides.empty() ? Json() : Json(overrides);
  json["poses"] = graph.vertices.size();
  json["edges"] = graph.edges.size();
  json["status"] = backend::to_text(run.status);
  json["status_message"] = run.status_message;
  json["iterations"] = run.num_iterations;
  json["dropped_edges"] = run.num_dropped;
  json["relinearized"] = run.num_relinearized;
  json["eliminated"] = run.num_eliminated;
  json["chi2"] = or_null(run.chi2);
  json["chi2_initial"] = or_null(run.chi2_initial);
  json["cost"] = or_null(run.cost);
  add_rejection(graph.edges.size(), options, run, json);
  json["total_s"] = run.total_s;
  json["init_s"] = is_incremental(command) ? Json() : Json(run.init_s);
  json["converge_s"] = or_null(run.converge_s);
  json["converge_rounds"] = or_null(run.converge_rounds);
  json["cpu_s"] = run.cpu_s;
  json["peak_rss_mib"] = or_null(run.peak_rss_mib);
  json["update_ms"] = update_times(run);
  return json;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : value.dump();
}

std::string to_text(const Json& run) {
  std::vector<std::vector<std::string>> rows{{"of the run", "value"}};
  for (const auto& item : run.items()) {
    if (item.value().is_null() || item.value() == "") continue;
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

Result<formats::PoseGraph> load(const SolveCommand& command) {
  const Result<catalog::Catalog> known = catalog::known_datasets(command.common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  return catalog::load_graph(command.graph, command.common.data_dirs(), *known);
}

Error of_graph(const SolveCommand& command, Error error) {
  if (error.where.empty()) error.where = command.graph;
  return error;
}

Result<void> write_solution(const SolveCommand& command, formats::PoseGraph graph,
                            const graph::Values& solution) {
  for (formats::PoseGraph::Vertex& vertex : graph.vertices) {
    vertex.T_map_base = solution.pose(vertex.id);
  }
  const auto format = *formats::graph_format_from_suffix(command.out);
  if (const auto written = formats::write_pose_graph(graph, command.out); !written) return written;
  if (command.is_json) return {};
  for (const std::string& loss : formats::losses_of_conversion(graph, format)) {
    command.common.say("lost: " + loss);
  }
  return {};
}

// What is wrong with an option's value, as CLI11 asks; empty for nothing.
std::string not_a_width(const std::string& text) {
  double width = 0;
  const char* end = text.data() + text.size();
  const auto [parsed_to, error] = std::from_chars(text.data(), end, width);
  const bool is_number = error == std::errc() && parsed_to == end && std::isfinite(width);
  if (is_number && width > 0) return "";
  return fmt::format(R"("{}" is no width; expected a finite number above 0)", text);
}

// A failed update leaves no estimate of the poses that were still to come.
bool has_answer(const solve::SolveRun& run) {
  return run.status != backend::SolveStatus::kRankDeficient &&
         run.status != backend::SolveStatus::kNotFinite;
}

}  // namespace

void SolveCommand::add_to(CLI::App& command) {
  command.add_option("graph", graph, "Pose graph (.g2o .graph .toro) or name of one")
      ->required()
      ->type_name("GRAPH");
  command.add_option("--backend", back_end, "Back-end; see list backends")
      ->required()
      ->type_name("B");
  command
      .add_option("--linear", linear,
                  "Factorisation of gauss-newton and levenberg (" +
                      backend::LeastSquaresParams().linear + ")")
      ->check(CLI::IsMember(texts_of(kLinearSolvers)));
  command.add_option("--mode", mode, "batch: all at once; incremental: pose by pose")
      ->check(CLI::IsMember({"batch", "incremental"}));
  command
      .add_option("--init", init,
                  "Initial values of batch: the file's, edges chained, or chordal relaxation "
                  "(file)")
      ->check(CLI::IsMember(std::vector<std::string>(kInits.begin(), kInits.end())));
  command
      .add_option("--robust", robust,
                  "Kernel of every edge (dcs: of loop closures), or what rejects false closures: "
                  "gnc, gnc-geman-mcclure, pcm")
      ->check(CLI::IsMember(robust_methods()));
  command.add_option("--width", width, "Width of the kernel in standard deviations (1)")
      ->check(not_a_width)
      ->type_name("K");
  command
      .add_option("--inlier-probability", inlier_probability,
                  "Of a true closure to be below the bound beyond which it is rejected (0.99)")
      ->check(CLI::Range(0.5, 0.999999))
      ->type_name("P");
  command.add_option("--rejected", rejected, "List of the rejected edges")->type_name("R.csv");
  command
      .add_option("--false-closures", false_closures,
                  "Plant false closures until they are this share of all closures")
      ->check(CLI::Range(0.0, 0.95))
      ->type_name("SHARE");
  command.add_option("--false-pairs", false_pairs, "Which poses they join (random)")
      ->check(CLI::IsMember(texts_of(kFalsePairs)));
  command.add_option("--seed", seed, "What is drawn for them (default: 1)");
  command
      .add_option("--every", every,
                  "Solve at every K-th pose of incremental; the others wait at their edges (1)")
      ->check(CLI::PositiveNumber)
      ->type_name("K");
  command
      .add_option(
          "--lag", lag,
          fmt::format("Poses in the window of fixed-lag ({})", backend::FixedLagParams().lag))
      ->type_name("N");
  command.add_option("--set", overrides, "Parameter of the back-end; repeat")
      ->type_name("BACKEND.key=value");
  command.add_flag("--converge", do_converge,
                   "After the last pose of incremental, go on until the gradient is small");
  command.add_option("--out", out, "The graph with its poses solved")->type_name("S.g2o");
  command.add_flag("--json", is_json, "One JSON document");
  common.add_to(command);
}

Result<ExitCode> SolveCommand::run() const {
  if (const Result<void> good = check_request(*this); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<ParamValues> set = overrides_of(*this);
  if (!set) return tl::make_unexpected(set.error());
  const auto solver = runner::make_back_end(back_end, default_settings(), *set);
  if (!solver) return tl::make_unexpected(solver.error());
  Result<formats::PoseGraph> problem = load(*this);
  if (!problem) return tl::make_unexpected(problem.error());
  solve::SolveOptions options = options_of(*this);
  options.make_back_end = [this, &set] {
    return *runner::make_back_end(back_end, round_settings(), *set);
  };
  if (false_closures) {
    const auto pairs = from_text(kFalsePairs, false_pairs.value_or("random"));
    const auto planted = plant(*problem, *false_closures, pairs, seed.value_or("1"));
    if (!planted) return tl::make_unexpected(of_graph(*this, planted.error()));
    options.num_planted = *planted;
  }
  const Result<solve::SolveRun> answer = solve::solve_graph(*problem, **solver, options);
  if (!answer) return tl::make_unexpected(of_graph(*this, answer.error()));
  if (!out.empty() && has_answer(*answer)) {
    const Result<void> written = write_solution(*this, *problem, (*solver)->estimate());
    if (!written) return tl::make_unexpected(written.error());
  }
  if (!rejected.empty() && has_answer(*answer)) {
    const Result<void> written =
        write_rejected(rejected, *problem, *answer, (*solver)->estimate(), options.num_planted);
    if (!written) return tl::make_unexpected(written.error());
  }
  const Json json = to_json(*this, *set, *problem, options, *answer);
  if (is_json) {
    std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    for (const std::string& note : problem->notes) common.say("note: " + note);
    std::fputs(to_text(json).c_str(), stdout);
  }
  // An update promises no convergence.
  const bool is_limit_an_answer = is_incremental(*this) && !do_converge;
  const bool has_converged = answer->status == backend::SolveStatus::kConverged;
  return has_converged || (is_limit_an_answer && has_answer(*answer)) ? runner::kExitDone
                                                                      : runner::kExitNo;
}

}  // namespace corridor::cli
