#include "bench/cli/data_command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <cstdio>

#include "bench/cli/list_command.hpp"
#include "bench/runner/exit_code.hpp"

namespace corridor::cli {

void DataListCommand::add_to(CLI::App& command) {
  command.add_flag("--json", is_json, "One JSON document, with everything that is known");
  common.add_to(command);
}

Result<ExitCode> DataListCommand::run() const {
  return ListCommand{common, "datasets", is_json}.run();
}

void DataVerifyCommand::add_to(CLI::App& command) {
  command.add_option("names", names, "Data sets (default: all)")->type_name("NAME");
  common.add_to(command);
}

Result<ExitCode> DataVerifyCommand::run() const {
  const Result<catalog::Catalog> known = catalog::known_datasets(common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  std::vector<std::string> wanted = names;
  if (wanted.empty()) {
    for (const catalog::CatalogEntry& entry : known->entries) wanted.push_back(entry.name);
  }
  std::vector<std::vector<std::string>> rows{{"data set", "file", "status"}};
  bool is_good = true;
  for (const std::string& name : wanted) {
    const auto files = catalog::verify_dataset(*known, name, common.data_dirs());
    if (!files) return tl::make_unexpected(files.error());
    for (const catalog::VerifiedFile& file : *files) {
      rows.push_back({name, file.path.string(), std::string(catalog::to_text(file.status))});
      const bool is_missing = file.status == catalog::FileStatus::kMissing;
      is_good = is_good && file.status != catalog::FileStatus::kDiffers &&
                !(is_missing && !names.empty());
    }
  }
  std::fputs(text_table(rows).c_str(), stdout);
  return is_good ? runner::kExitDone : runner::kExitNo;
}

}  // namespace corridor::cli
