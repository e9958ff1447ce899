#include "bench/cli/solve_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/cli/option_checks.hpp"
#include "bench/cli/solve_answer.hpp"
#include "bench/cli/solve_closures.hpp"
#include "bench/cli/solve_request.hpp"
#include "bench/cli/solve_tree.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/solve/false_closures.hpp"
#include "bench/solve/robust_method.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/core/enum_text.hpp"
#include "slam/core/nearest_names.hpp"
#include "slam/linear/make_linear_solver.hpp"

namespace corridor::cli {
namespace {

// Of a window, or between solutions.
constexpr int kMaxPoses = 1'000'000;

// What is neither a name nor a graph's file by its suffix.
Result<void> check_name(const std::string& graph, const catalog::Catalog& known) {
  if (catalog::is_graph_name(graph, known) || known.find(graph) != nullptr) return {};
  std::vector<std::string> names;
  for (const catalog::CatalogEntry& entry : known.entries) {
    if (entry.is_graph()) names.push_back(entry.name);
  }
  return fail(ErrorCode::kNotFound, "neither a graph of the catalogue nor a file of one", graph,
              fmt::format("a name that ends in .g2o, .graph or .toro, or one of `data list`; the "
                          "nearest names: {}",
                          fmt::join(nearest_names(graph, names), ", ")));
}

Result<formats::PoseGraph> load(const SolveCommand& command) {
  const Result<catalog::Catalog> known = catalog::known_datasets(command.common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  if (const Result<void> named = check_name(command.graph, *known); !named) {
    return tl::make_unexpected(named.error());
  }
  auto loaded = catalog::load_graph(command.graph, command.common.data_dirs(), *known);
  if (!loaded) return tl::make_unexpected(loaded.error());
  if (const Result<void> good = check_tree_size(command, loaded->graph); !good) {
    return tl::make_unexpected(good.error());
  }
  return std::move(loaded->graph);
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

Result<void> write_files(const SolveCommand& command, const formats::PoseGraph& graph,
                         const solve::SolveRun& run, const graph::Values& solution,
                         std::size_t num_planted) {
  if (!command.out.empty()) {
    if (const auto written = write_solution(command, graph, solution); !written) return written;
  }
  if (command.rejected.empty()) return {};
  return write_rejected(command.rejected, graph, run, solution, num_planted);
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
      ->check(CLI::IsMember(texts_of(linear::kLinearSolvers)));
  command.add_option("--mode", mode, "batch: all at once; incremental: pose by pose (batch)")
      ->check(CLI::IsMember({"batch", "incremental"}));
  command
      .add_option("--init", init,
                  "Initial values of batch: the file's, edges chained, or chordal relaxation "
                  "(file)")
      ->check(CLI::IsMember(texts_of(solve::kInitializations)));
  command
      .add_option("--robust", robust,
                  "Kernel of the loop closures, or what rejects false ones: "
                  "gnc, gnc-geman-mcclure, pcm")
      ->check(CLI::IsMember(solve::robust_methods()));
  command.add_option("--width", width, "Width of the kernel in standard deviations (1)")
      ->check(number_above_zero())
      ->type_name("K");
  command
      .add_option("--inlier-probability", inlier_probability,
                  "Of a true closure to be below the bound beyond which it is rejected (0.99)")
      ->check(number_in(0.5, 0.999999))
      ->type_name("P");
  command.add_option("--rejected", rejected, "List of the rejected edges")->type_name("R.csv");
  command
      .add_option("--false-closures", false_closures,
                  "Plant false closures until they are this share of all closures")
      ->check(number_in(0, 0.95))
      ->type_name("SHARE");
  command.add_option("--false-pairs", false_pairs, "Which poses they join (random)")
      ->check(CLI::IsMember(texts_of(solve::kFalsePairs)));
  command.add_option("--seed", seed, "What is drawn for them (default: 1)");
  command
      .add_option("--every", every,
                  "Solve at every K-th pose of incremental; the others wait at their edges (1)")
      ->check(whole_number_in(1, kMaxPoses))
      ->type_name("K");
  command
      .add_option(
          "--lag", lag,
          fmt::format("Poses in the window of fixed-lag ({})", backend::FixedLagParams().lag))
      ->check(whole_number_in(1, kMaxPoses))
      ->type_name("N");
  command.add_option("--set", overrides, "Parameter of the back-end; repeat")
      ->type_name("BACKEND.key=value");
  command.add_flag(
      "--converge", do_converge,
      "After the last pose of incremental, go on until a step promises next to nothing");
  command.add_option("--out", out, "The graph with its poses solved")->type_name("S.g2o");
  command
      .add_option("--tree", tree,
                  fmt::format("Picture of isam2's Bayes tree before and after the last update of "
                              "incremental; up to {} poses",
                              kMaxPosesOfTree))
      ->type_name("T.svg");
  command.add_flag("--json", is_json, "One JSON document");
  common.add_to(command);
}

Result<ExitCode> SolveCommand::run(const TreeDrawer& draw_tree) const {
  if (const Result<void> good = check_request(*this); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<ParamValues> set = overrides_of(*this);
  if (!set) return tl::make_unexpected(set.error());
  const auto solver = runner::make_back_end(back_end, settings_of_solve(), *set);
  if (!solver) return tl::make_unexpected(solver.error());
  Result<formats::PoseGraph> problem = load(*this);
  if (!problem) return tl::make_unexpected(problem.error());
  solve::SolveOptions options = options_of(*this);
  options.make_back_end = [this, &set] {
    return *runner::make_back_end(back_end, solve::round_settings(settings_of_solve()), *set);
  };
  if (false_closures) {
    const auto pairs = *from_text(solve::kFalsePairs, false_pairs.value_or("random"));
    const auto planted = plant(*problem, *false_closures, pairs, seed.value_or("1"));
    if (!planted) return tl::make_unexpected(of_graph(*this, planted.error()));
    options.num_planted = *planted;
    if (*planted == 0) problem->notes.emplace_back("the share is less than one false closure");
  }
  LastUpdate last_update;
  if (!tree.empty()) last_update.watch(options);
  const Result<solve::SolveRun> answer = solve::solve_graph(*problem, **solver, options);
  if (!answer) return tl::make_unexpected(of_graph(*this, answer.error()));
  // A failed update leaves no estimate of the poses that were still to come.
  const bool has_answer = !backend::has_failed(answer->status);
  if (has_answer) {
    Result<void> written =
        write_files(*this, *problem, *answer, (*solver)->estimate(), options.num_planted);
    if (written && !tree.empty()) written = last_update.write(*this, *problem, draw_tree);
    if (!written) return tl::make_unexpected(written.error());
  }
  const auto parameters = runner::back_end_parameters(back_end, settings_of_solve(), *set);
  const nlohmann::ordered_json json = to_json(*this, *parameters, *set, *problem, options, *answer);
  if (is_json) {
    std::puts(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
  } else {
    for (const auto& note : json["notes"]) common.say("note: " + note.get<std::string>());
    std::fputs(to_text(json).c_str(), stdout);
  }
  // An update promises no convergence.
  const bool is_limit_an_answer = is_incremental(*this) && !do_converge;
  const bool has_converged = answer->status == backend::SolveStatus::kConverged;
  return has_converged || (is_limit_an_answer && has_answer) ? runner::kExitDone : runner::kExitNo;
}

}  // namespace corridor::cli
