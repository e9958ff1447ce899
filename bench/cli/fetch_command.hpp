// corridor-bench data fetch [NAME...]: downloads what the catalogue names a public address for.
#pragma once

#include <string>
#include <vector>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct FetchCommand {
  CommonOptions common;
  std::vector<std::string> names;  // empty: every data set that can be fetched

  void add_to(CLI::App& command);
  // Into --data-dir, else into the cache folder. 0: all of it is here; 1: a download failed, a file
  // is not the catalogue's, or a data set that was named cannot be fetched.
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
