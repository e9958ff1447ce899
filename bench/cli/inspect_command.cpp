#include "bench/cli/inspect_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/cli/log_report.hpp"
#include "bench/runner/case_data.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/catalog/load_dataset.hpp"
#include "datasets/formats/log_health.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/simulation/truth.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// What lies beside a log, and why `run` and `convert` refuse the log for it.
struct Companions {
  std::optional<std::size_t> num_relations;
  std::vector<std::string> defects;

  void refuse(const Error& error) { defects.push_back(error.to_line()); }
};

void look_at_relations(const fs::path& file, SensorLog& log, Companions& companions) {
  const auto relations = formats::read_relations(file);
  if (!relations) return companions.refuse(relations.error());
  companions.num_relations = relations->size();
  const std::size_t num_repeated = formats::num_repeated(*relations);
  if (num_repeated > 0) {
    log.provenance.notes.push_back(fmt::format("{} relations stand twice", num_repeated));
  }
  if (const auto good = runner::check_relations(log, *relations); !good) {
    companions.refuse(good.error());
  }
}

Companions companions_of(const catalog::LogSource& source, formats::LogAsFound& found) {
  Companions companions;
  if (found.refused_truth) companions.refuse(*found.refused_truth);
  if (const auto good = runner::check_truth(found.log); !good) companions.refuse(good.error());
  const auto look_at = [&](const char* suffix, const auto& look) {
    const auto file = formats::find_sidecar(source.path, suffix, source.options);
    if (!file) companions.refuse(file.error());
    if (file && *file) look(**file);
  };
  look_at(".relations",
          [&](const fs::path& file) { look_at_relations(file, found.log, companions); });
  look_at(".truth.toml", [&](const fs::path& file) {
    const auto world = simulation::read_truth(file);
    if (!world) companions.refuse(world.error());
  });
  return companions;
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

  const Companions companions = companions_of(*source, *found);
  const formats::EventPlaces places{std::move(found->origins), found->origin_unit};
  formats::LogHealth health = formats::examine(found->log, places);
  health.defects.insert(health.defects.begin(), companions.defects.begin(),
                        companions.defects.end());
  // By this name nothing else loads it.
  for (const std::string& line : source->other_checksums) {
    health.defects.insert(health.defects.begin(),
                          fmt::format("{}: refused as data set {}", line, source->name));
  }
  const LogReport report{&found->log, &health, &found->robot_keys, found->applied_time_offset_s,
                         companions.num_relations};
  const std::string text =
      is_json ? to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
              : to_text(report);
  std::fputs(text.c_str(), stdout);
  return health.defects.empty() ? runner::kExitDone : runner::kExitNo;
}

}  // namespace corridor::cli
