#include "bench/cli/list_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/results/result_keys.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/data_kind.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/suite.hpp"
#include "bench/runner/systems.hpp"
#include "datasets/simulation/scenario.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::cli {
namespace {

using Json = nlohmann::ordered_json;

// One array of objects, and which of their keys the text form shows.
struct Listing {
  Json items = Json::array();
  std::vector<std::string> columns;
  std::string remark;  // below the text form
};

Json names_of(const std::vector<runner::ProfileInfo>& profiles) {
  Json names = Json::array();
  for (const auto& profile : profiles) names.push_back(profile.name);
  return names;
}

Result<Listing> list_systems(const CommonOptions&) {
  Listing listing{
      Json::array(),
      {"name", "profiles", "backend", "takes", "needs_imu", "needs_wheels", "description"},
      ""};
  for (const runner::SystemInfo& info : runner::systems()) {
    listing.items.push_back(
        {{"name", info.name},
         {"description", info.description},
         {"profiles", names_of(info.profiles)},
         {"backend", info.default_backend ? Json(*info.default_backend) : Json(nullptr)},
         {"takes", info.takes_graphs() ? "graph" : "log"},
         {"needs_imu", info.needs_imu},
         {"needs_wheels", info.needs_wheels},
         {"is_stochastic", info.is_stochastic}});
  }
  return listing;
}

Json parameters_of(const std::vector<ParamRow>& rows) {
  Json parameters = Json::array();
  for (const ParamRow& row : rows) {
    parameters.push_back({{"name", row.name},
                          {"type", row.type},
                          {"value", row.value},
                          {"unit", row.unit},
                          {"range", row.range},
                          {"meaning", row.meaning}});
  }
  return parameters;
}

Result<Listing> list_profiles(const CommonOptions&) {
  Listing listing{Json::array(), {"name", "description"}, ""};
  for (const runner::SystemInfo& info : runner::systems()) {
    for (const runner::ProfileInfo& profile : info.profiles) {
      listing.items.push_back({{"name", info.name + "@" + profile.name},
                               {"system", info.name},
                               {"profile", profile.name},
                               {"description", profile.description},
                               {"parameters", parameters_of(info.param_table(profile.name))}});
    }
  }
  return listing;
}

Result<Listing> list_backends(const CommonOptions&) {
  Listing listing{Json::array(), {"name", "description"}, ""};
  for (const runner::BackEndInfo& info : runner::back_ends()) {
    listing.items.push_back({{"name", info.name},
                             {"description", info.description},
                             {"parameters", parameters_of(info.parameters)}});
  }
  return listing;
}

// None as null, which a table shows as "-".
Json to_json(const std::vector<std::filesystem::path>& paths) {
  Json texts;
  for (const std::filesystem::path& path : paths) texts.push_back(path.string());
  return texts;
}

Result<Listing> list_datasets(const CommonOptions& common) {
  const Result<catalog::Catalog> known = catalog::known_datasets(common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  Listing listing{Json::array(),
                  {"name", "format", "truth", "is_found", "is_fetchable", "title"},
                  "is_found: files of those names are there; data verify compares checksums\n"};
  bool has_own = false;
  bool has_incomplete = false;
  for (const catalog::DatasetRow& row : catalog::list_datasets(*known, common.data_dirs())) {
    listing.items.push_back(
        {{"name", row.name},
         {"title", row.title},
         {"format", row.format},
         {"truth", catalog::to_text(row.truth)},
         {"is_found", row.is_found},
         {"is_readable", row.is_readable},
         {"path", row.path.empty() ? Json(nullptr) : Json(row.path.string())},
         {"missing_files", to_json(row.missing_files)},
         {"licence", row.licence},
         {"source", row.source},
         {"is_fetchable", row.is_fetchable},
         {"refused", nullptr},
         {"not_fetchable", row.is_fetchable ? Json(nullptr) : Json(row.not_fetchable)},
         {"catalogue", row.is_own ? Json(row.catalog_file.string()) : Json("built in")}});
    if (const auto clear = runner::check_one_meaning(row.name, *known); !clear) {
      listing.items.back()["refused"] = clear.error().to_line();
      listing.remark += fmt::format("refused by that name: {}\n", clear.error().to_line());
    }
    has_own = has_own || row.is_own;
    has_incomplete = has_incomplete || !row.missing_files.empty();
  }
  if (has_own) listing.columns.insert(listing.columns.end() - 1, "catalogue");
  if (has_incomplete) listing.columns.insert(listing.columns.end() - 1, "missing_files");
  return listing;
}

Result<Listing> list_scenarios(const CommonOptions&) {
  Listing listing{Json::array(), {"name", "family", "description"}, ""};
  for (const std::filesystem::path& path : simulation::list_scenarios()) {
    const Result<simulation::Scenario> scenario = simulation::read_scenario(path);
    if (!scenario) return tl::make_unexpected(scenario.error());
    const auto members = simulation::scenario_members(scenario->name);
    if (!members) return tl::make_unexpected(members.error());
    const bool is_family = members->front() != scenario->name;
    listing.items.push_back(
        {{"name", scenario->name},
         {"description", scenario->description},
         {"family", is_family ? Json(fmt::format("of {}", members->size())) : Json(nullptr)},
         {"members", *members},
         {"path", path.string()},
         {"parameters", parameters_of(simulation::scenario_table(*scenario))}});
  }
  return listing;
}

Result<Listing> list_suites(const CommonOptions&) {
  Listing listing{Json::array(), {"name", "description"}, ""};
  for (const std::filesystem::path& path : runner::list_suites()) {
    const Result<runner::Suite> suite = runner::read_suite(path);
    if (!suite) return tl::make_unexpected(suite.error());
    Json systems = Json::array();
    for (const auto& choice : suite->systems) {
      systems.push_back(choice.system + "@" + choice.profile);
    }
    listing.items.push_back({{"name", suite->name},
                             {"description", suite->description},
                             {"path", path.string()},
                             {"systems", systems},
                             {"scenarios", suite->scenarios},
                             {"datasets", suite->datasets},
                             {"num_seeds", suite->num_seeds}});
  }
  return listing;
}

Result<Listing> list_metrics(const CommonOptions&) {
  Listing listing{Json::array(), {"name", "unit", "meaning"}, ""};
  for (const results::ResultKey& key : results::result_keys()) {
    if (!key.is_metric) continue;
    listing.items.push_back({{"name", key.name}, {"unit", key.unit}, {"meaning", key.meaning}});
  }
  return listing;
}

Result<Listing> list_stages(const CommonOptions&) {
  Listing listing{Json::array(), {"name"}, ""};
  for (const std::string_view name : kStageNames) listing.items.push_back({{"name", name}});
  return listing;
}

using Lister = Result<Listing> (*)(const CommonOptions&);

const std::map<std::string, Lister>& listers() {
  static const std::map<std::string, Lister> all = {
      {"systems", list_systems},   {"profiles", list_profiles},   {"backends", list_backends},
      {"datasets", list_datasets}, {"scenarios", list_scenarios}, {"suites", list_suites},
      {"metrics", list_metrics},   {"stages", list_stages}};
  return all;
}

std::string cell_text(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& element : value) {
    if (!text.empty()) text += ",";
    text += cell_text(element);
  }
  return text;
}

std::string to_text(const Listing& listing) {
  std::vector<std::vector<std::string>> rows{listing.columns};
  for (const Json& item : listing.items) {
    std::vector<std::string>& row = rows.emplace_back();
    for (const std::string& column : listing.columns) row.push_back(cell_text(item.at(column)));
  }
  return text_table(rows) + listing.remark;
}

}  // namespace

void ListCommand::add_to(CLI::App& command) {
  std::vector<std::string> kinds;
  for (const auto& [name, lister] : listers()) kinds.push_back(name);
  command.add_option("what", what, "What to list")->required()->check(CLI::IsMember(kinds));
  command.add_flag("--json", is_json, "One JSON document, with everything that is known");
  common.add_to(command);
}

Result<ExitCode> ListCommand::run() const {
  const Result<Listing> listing = listers().at(what)(common);
  if (!listing) return tl::make_unexpected(listing.error());
  const std::string text =
      is_json ? listing->items.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
              : to_text(*listing);
  std::fputs(text.c_str(), stdout);
  return runner::kExitDone;
}

}  // namespace corridor::cli
