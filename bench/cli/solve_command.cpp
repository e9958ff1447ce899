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
#include <system_error>
#include <utility>

#include "bench/cli/staged_files.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/solve/solve_graph.hpp"
#include "bench/statistics/quantiles.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::cli {
namespace {

using Json = nlohmann::ordered_json;
using graph::KernelKind;
using linear::LinearSolverKind;

constexpr std::array kKernels = {KernelKind::kNone, KernelKind::kHuber, KernelKind::kCauchy,
                                 KernelKind::kGemanMcClure};
constexpr std::array kLinearSolvers = {LinearSolverKind::kCholmod, LinearSolverKind::kBlock};
// In the order of solve::Initialization.
constexpr std::array<std::string_view, 3> kInits = {"file", "odometry", "chordal"};

// Iterations of a batch solution: Levenberg-Marquardt takes many more than plain Gauss-Newton.
constexpr int kMaxIterations = 100;
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

bool is_incremental(const SolveCommand& command) { return command.mode == "incremental"; }

// These solve by slam/linear; the others bring a factorisation of their own.
bool has_linear_solver(const SolveCommand& command) {
  return command.back_end == "gauss-newton" || command.back_end == "levenberg";
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
  if (command.init && is_incremental(command)) {
    return not_together("--init", "poses that come one by one start at their edges",
                        "--mode batch with it");
  }
  if (command.every && !is_incremental(command)) {
    return not_together("--every", "a batch solution has no updates", "--mode incremental with it");
  }
  if (command.width && command.robust == "none") {
    return not_together("--width", "without a kernel there is no width", "--robust with it");
  }
  if (command.out.empty()) return {};
  if (!formats::graph_format_from_suffix(command.out)) {
    return fail(ErrorCode::kUnsupported, "unknown kind of graph", command.out,
                "a name that ends in .g2o, .graph or .toro");
  }
  std::error_code ignored;
  if (std::filesystem::equivalent(command.graph, command.out, ignored)) {
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
  options.kernel.kind = from_text(kKernels, command.robust);
  options.kernel.width = command.width.value_or(1.0);
  return options;
}

backend::LeastSquaresParams settings_of(const SolveCommand& command) {
  backend::LeastSquaresParams settings;
  settings.max_iterations = kMaxIterations;
  settings.min_relative_decrease = kMinRelativeDecrease;
  if (command.linear) settings.linear = from_text(kLinearSolvers, *command.linear);
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

Json to_json(const SolveCommand& command, const formats::PoseGraph& graph,
             const solve::SolveRun& run) {
  const solve::SolveOptions options = options_of(command);
  Json json;
  json["graph"] = command.graph;
  json["backend"] = command.back_end;
  json["linear"] = has_linear_solver(command) ? Json(to_text(settings_of(command).linear)) : Json();
  json["mode"] = command.mode;
  json["init"] = is_incremental(command) ? Json() : Json(command.init.value_or("file"));
  json["robust"] = command.robust;
  json["width"] = command.robust == "none" ? Json() : Json(options.kernel.width);
  json["every"] = is_incremental(command) ? Json(options.poses_per_update) : Json();
  json["poses"] = graph.vertices.size();
  json["edges"] = graph.edges.size();
  json["status"] = backend::to_text(run.status);
  json["status_message"] = run.status_message;
  json["iterations"] = run.num_iterations;
  json["relinearized"] = run.num_relinearized;
  json["eliminated"] = run.num_eliminated;
  json["chi2"] = or_null(run.chi2);
  json["chi2_initial"] = or_null(run.chi2_initial);
  json["cost"] = or_null(run.cost);
  json["total_s"] = run.total_s;
  json["init_s"] = is_incremental(command) ? Json() : Json(run.init_s);
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
  auto loaded = catalog::load_graph(command.graph, command.common.data_dirs(), *known);
  if (!loaded) return tl::make_unexpected(loaded.error());
  return std::move(loaded->graph);
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
                      linear::to_text(backend::LeastSquaresParams().linear) + ")")
      ->check(CLI::IsMember(texts_of(kLinearSolvers)));
  command.add_option("--mode", mode, "batch: all at once; incremental: pose by pose")
      ->check(CLI::IsMember({"batch", "incremental"}));
  command
      .add_option("--init", init,
                  "Initial values of batch: the file's, edges chained, or chordal relaxation "
                  "(file)")
      ->check(CLI::IsMember(std::vector<std::string>(kInits.begin(), kInits.end())));
  command.add_option("--robust", robust, "Kernel of every edge")
      ->check(CLI::IsMember(texts_of(kKernels)));
  command.add_option("--width", width, "Width of the kernel in standard deviations (1)")
      ->check(not_a_width)
      ->type_name("K");
  command.add_option("--every", every, "Poses per update of incremental (1)")
      ->check(CLI::PositiveNumber)
      ->type_name("K");
  command.add_option("--out", out, "The graph with its poses solved")->type_name("S.g2o");
  command.add_flag("--json", is_json, "One JSON document");
  common.add_to(command);
}

Result<ExitCode> SolveCommand::run() const {
  if (const Result<void> good = check_request(*this); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<formats::PoseGraph> problem = load(*this);
  if (!problem) return tl::make_unexpected(problem.error());
  const auto solver = runner::make_back_end(back_end, settings_of(*this));
  if (!solver) return tl::make_unexpected(solver.error());
  const Result<solve::SolveRun> answer = solve::solve_graph(*problem, **solver, options_of(*this));
  if (!answer) {
    Error error = answer.error();
    error.where = graph;
    return tl::make_unexpected(std::move(error));
  }
  if (!out.empty() && has_answer(*answer)) {
    const Result<void> written = write_solution(*this, *problem, (*solver)->estimate());
    if (!written) return tl::make_unexpected(written.error());
  }
  const Json json = to_json(*this, *problem, *answer);
  if (is_json) {
    std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    for (const std::string& note : problem->notes) common.say("note: " + note);
    std::fputs(to_text(json).c_str(), stdout);
  }
  const bool is_limit_an_answer = is_incremental(*this);  // an update promises no convergence
  const bool has_converged = answer->status == backend::SolveStatus::kConverged;
  return has_converged || (is_limit_an_answer && has_answer(*answer)) ? runner::kExitDone
                                                                      : runner::kExitNo;
}

}  // namespace corridor::cli
