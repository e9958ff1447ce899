#include "bench/cli/inspect_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "bench/cli/log_report.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/catalog/load_dataset.hpp"
#include "datasets/formats/log_health.hpp"
#include "datasets/formats/trajectories/relations.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// Relations that cannot be read are a note, as truth that cannot be.
std::optional<std::size_t> num_relations_of(const catalog::LogSource& source,
                                            std::vector<std::string>& notes) {
  const auto path = formats::find_sidecar(source.path, ".relations", source.options);
  if (!path) return std::nullopt;
  const auto relations = formats::read_relations(*path);
  if (relations) {
    const std::size_t num_repeated = formats::num_repeated(*relations);
    if (num_repeated > 0) notes.push_back(fmt::format("{} relations stand twice", num_repeated));
    return relations->size();
  }
  notes.push_back("kept although refused: " + relations.error().to_line());
  return std::nullopt;
}

Result<catalog::LogSource> find(const std::string& log, const CommonOptions& common) {
  std::error_code ignored;
  if (fs::is_directory(log, ignored)) {
    return fail(ErrorCode::kInvalid, "this is a folder", log,
                "a log file, or the name of a data set");
  }
  const Result<catalog::Catalog> known = catalog::known_datasets(common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  catalog::LoadOptions options;
  options.accept_other_checksum = true;  // looked at, and a defect; nothing is scored
  return catalog::find_log(log, common.data_dirs(), *known, options);
}

}  // namespace

void InspectCommand::add_to(CLI::App& command) {
  command.add_option("log", log, "A log file, or the name of a data set")
      ->required()
      ->type_name("LOG|NAME");
  command.add_flag("--json", is_json, "One JSON document, with every defect");
  common.add_to(command);
}

Result<ExitCode> InspectCommand::run() const {
  const Result<catalog::LogSource> source = find(log, common);
  if (!source) return tl::make_unexpected(source.error());
  auto found = formats::read_log_as_found(source->path, source->options);
  if (!found) return tl::make_unexpected(found.error());
  found->log.provenance.name = source->name;
  auto& notes = found->log.provenance.notes;
  notes.insert(notes.end(), source->notes.begin(), source->notes.end());

  const formats::EventPlaces places{std::move(found->origins), found->origin_unit};
  formats::LogHealth health = formats::examine(found->log, places);
  // By this name nothing else loads it.
  for (const std::string& line : source->other_checksums) {
    health.defects.insert(health.defects.begin(),
                          fmt::format("{}: refused as data set {}", line, source->name));
  }
  const auto num_relations = num_relations_of(*source, notes);
  const LogReport report{&found->log, &health, num_relations};
  const std::string text =
      is_json ? to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
              : to_text(report);
  std::fputs(text.c_str(), stdout);
  return health.defects.empty() ? runner::kExitDone : runner::kExitNo;
}

}  // namespace corridor::cli
