#include "bench/cli/solve_request.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "bench/cli/solve_tree.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/overrides.hpp"
#include "bench/solve/robust_method.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/core/enum_text.hpp"

namespace corridor::cli {
namespace {

tl::unexpected<Error> not_together(const std::string& option, const std::string& why,
                                   const std::string& expected) {
  return fail(ErrorCode::kInvalid, why, option, expected);
}

Result<void> check_robust(const SolveCommand& command) {
  const bool is_rejection = solve::rejection_of(command.robust) != solve::Rejection::kNone;
  if (is_rejection && is_incremental(command)) {
    return not_together("--robust", command.robust + " looks at all edges at once",
                        "--mode batch with it, or dcs");
  }
  if (command.width && (command.robust == "none" || is_rejection)) {
    return not_together("--width", "without a kernel there is no width",
                        "--robust with the name of a kernel");
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

}  // namespace

bool is_incremental(const SolveCommand& command) { return command.mode == "incremental"; }

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
  if (const Result<void> good = check_tree(command); !good) return good;
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

solve::SolveOptions options_of(const SolveCommand& command) {
  solve::SolveOptions options;
  if (is_incremental(command)) options.mode = solve::Mode::kIncremental;
  options.init = *from_text(solve::kInitializations, command.init.value_or("file"));
  options.poses_per_update = command.every.value_or(1);
  options.do_converge = command.do_converge;
  solve::set_robust_method(command.robust, command.width.value_or(options.kernel.width), options);
  options.inlier_probability = command.inlier_probability.value_or(options.inlier_probability);
  return options;
}

backend::LeastSquaresParams settings_of_solve() {
  backend::LeastSquaresParams settings;
  settings.max_iterations = solve::kMaxBatchIterations;
  settings.min_relative_decrease = solve::kMinBatchRelativeDecrease;
  return settings;
}

}  // namespace corridor::cli
