#include "bench/cli/evaluate_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "bench/metrics/score_case.hpp"
#include "bench/results/result_json.hpp"
#include "bench/results/result_keys.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/truth.hpp"

namespace corridor::cli {
namespace {

using Json = nlohmann::ordered_json;

// The files of a request, read.
struct Inputs {
  Trajectory estimate;
  std::optional<Trajectory> truth;
  std::vector<formats::Relation> relations;
  std::optional<GridMap> map;
  std::optional<simulation::World> world;
  double lidar_range_m = 0;
};

// Reads `path` into `value` unless it is empty. `expected` completes errors that do not say it.
template <class T, class Read>
Result<void> read_into(const std::string& path, T& value, Read read, const char* expected) {
  if (path.empty()) return {};
  auto content = read(std::filesystem::path(path));
  if (!content) {
    Error error = content.error();
    if (error.expected.empty()) error.expected = expected;
    return tl::make_unexpected(std::move(error));
  }
  value = std::move(*content);
  return {};
}

// A LOG.truth.toml or a scenario: both say what the walls are and how far the LiDAR sees.
Result<void> read_world_into(const std::string& path, Inputs& inputs) {
  if (path.empty()) return {};
  Result<simulation::World> world = simulation::read_world(path);
  if (!world) return tl::make_unexpected(world.error());
  inputs.world = std::move(*world);
  if (const auto truth = simulation::read_truth(path)) {
    inputs.lidar_range_m = truth->range_max_m;
    return {};
  }
  const auto scenario = simulation::read_scenario(path);
  if (!scenario) return tl::make_unexpected(scenario.error());
  inputs.lidar_range_m = scenario->lidar.range_max_m;
  return {};
}

Result<Inputs> read_inputs(const EvaluateCommand& command) {
  constexpr const char* kTrajectory = "a trajectory, TUM";
  Inputs inputs;
  Result<void> done = read_into(command.estimate, inputs.estimate, formats::read_tum, kTrajectory);
  if (done) done = read_into(command.truth, inputs.truth, formats::read_tum, kTrajectory);
  if (done)
    done = read_into(command.relations, inputs.relations, formats::read_relations,
                     "a file of relations");
  if (done)
    done =
        read_into(command.map, inputs.map, formats::read_ros_map, "a map as ROS map_server has it");
  if (done) done = read_world_into(command.world, inputs);
  if (!done) return tl::make_unexpected(done.error());
  return inputs;
}

Result<void> check_request(const EvaluateCommand& command) {
  if (command.truth.empty() && command.relations.empty()) {
    return fail(ErrorCode::kInvalid, "there is nothing to compare with", "evaluate",
                "--truth or --relations or both");
  }
  if (command.map.empty() != command.world.empty()) {
    return fail(ErrorCode::kInvalid, "--map and --world are not both given", "evaluate",
                "a map and the world it shows");
  }
  if (!command.map.empty() && command.truth.empty()) {
    return fail(ErrorCode::kInvalid, "a map can be laid into its world only by the truth",
                "evaluate", "--truth");
  }
  const std::string suffix = std::filesystem::path(command.map).extension();
  if (!command.map.empty() && suffix != ".yaml" && suffix != ".yml") {
    return fail(ErrorCode::kUnsupported, "the suffix is not that of a map's description",
                "--map " + command.map,
                "the .yaml of ROS map_server, which names the image of the map");
  }
  return {};
}

// What is wrong with an option's value, as CLI11 asks; empty for nothing.
std::string not_a_time_span(const std::string& text) {
  double value_s = 0;
  const char* end = text.data() + text.size();
  const auto [parsed_to, error] = std::from_chars(text.data(), end, value_s);
  const bool is_number = error == std::errc() && parsed_to == end && std::isfinite(value_s);
  if (is_number && value_s >= 0) return "";
  return fmt::format(R"("{}" is no time span; expected seconds, 0 or more)", text);
}

metrics::CaseEvidence evidence_of(const Inputs& inputs) {
  metrics::CaseEvidence evidence;
  evidence.final_trajectory = &inputs.estimate;
  if (inputs.truth) evidence.truth_world = &*inputs.truth;
  evidence.relations = inputs.relations;
  if (inputs.map) evidence.own_map = &*inputs.map;
  if (inputs.world) evidence.world = &*inputs.world;
  evidence.lidar_range_m = inputs.lidar_range_m;
  return evidence;
}

// The keys of result.json that speak of files, with the names they have there.
Json scores_json(const results::RunResult& result) {
  const Json all = Json::parse(results::to_json(result));
  Json scores = Json::object();
  for (const char* name : {"poses_expected", "poses_matched", "association", "alignment"}) {
    scores[name] = all.at(name);
  }
  const auto take = [&](const results::ResultKey& key, const auto&) {
    scores[key.name] = all.at(key.name);
  };
  results::detail::visit_trajectory("", result.final_scores, take);
  results::detail::visit_relations("", result.final_relations, take);
  results::detail::visit_map("", result.own_map, take);
  return scores;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6f}", value.get<double>());
  return value.dump();
}

std::string to_text(const Json& scores) {
  std::map<std::string, std::string> units;
  for (const results::ResultKey& key : results::result_keys()) units[key.name] = key.unit;
  std::vector<std::vector<std::string>> rows{{"score", "value", "unit"}};
  for (const auto& item : scores.items()) {
    if (item.value().is_null()) continue;
    if (item.key() != "key_distances") {
      rows.push_back({item.key(), value_text(item.value()), units[item.key()]});
      continue;
    }
    for (const auto& key : item.value().items()) {
      for (const auto& part : key.value().items()) {
        if (part.value().is_null()) continue;
        rows.push_back({fmt::format("{}.{}", key.key(), part.key()), value_text(part.value()), ""});
      }
    }
  }
  return text_table(rows);
}

}  // namespace

void EvaluateCommand::add_to(CLI::App& command) {
  command.add_option("--estimate", estimate, "Estimated trajectory, TUM")
      ->required()
      ->type_name("E.tum");
  command.add_option("--truth", truth, "True trajectory, TUM")->type_name("T.tum");
  command.add_option("--relations", relations, "True relative poses")->type_name("R");
  command.add_option("--map", map, "Estimated map, as ROS map_server has it")->type_name("M.yaml");
  command.add_option("--world", world, "The world of the map: LOG.truth.toml or a scenario")
      ->type_name("W.toml");
  command
      .add_option("--align", alignment,
                  "origin: first poses on each other; se2: best rigid motion; none")
      ->check(CLI::IsMember({"origin", "se2", "none"}));
  command.add_option("--max-dt", max_dt_s, "Largest difference of matched stamps [s] (0.01)")
      ->check(not_a_time_span);
  command.add_option("--associate", association, "How stamps are matched")
      ->check(CLI::IsMember({"nearest", "interpolate"}));
  command.add_flag("--json", is_json, "One JSON document with the keys of result.json");
  common.add_to(command);
}

Result<ExitCode> EvaluateCommand::run() const {
  if (const Result<void> good = check_request(*this); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<Inputs> inputs = read_inputs(*this);
  if (!inputs) return tl::make_unexpected(inputs.error());

  metrics::ScoringOptions options;
  options.alignment = *metrics::alignment_from_text(alignment);
  options.association = *metrics::association_rule_from_text(association);
  options.max_dt_s = max_dt_s;
  results::RunResult result;
  const std::vector<std::string> remarks =
      metrics::score_case(evidence_of(*inputs), options, result);
  if (inputs->truth && result.poses_matched.value_or(0) == 0) {
    return fail(ErrorCode::kInvalid,
                fmt::format("no pose could be matched{}{}", remarks.empty() ? "" : ": ",
                            fmt::join(remarks, "; ")),
                estimate, "stamps of the same clock and unit as those of " + truth);
  }

  if (!inputs->relations.empty() && result.final_relations.relations_used.value_or(0) == 0) {
    return fail(ErrorCode::kInvalid, "no relation could be matched", estimate,
                "poses within " +
                    fmt::format("{} s of both times of a relation in {}", max_dt_s, relations));
  }

  Json scores = scores_json(result);
  if (is_json) {
    scores["remarks"] = remarks;
    std::puts(scores.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return runner::kExitDone;
  }
  std::fputs(to_text(scores).c_str(), stdout);
  for (const std::string& remark : remarks) common.say("remark: " + remark);
  return runner::kExitDone;
}

}  // namespace corridor::cli
