// What the commands of the program share. Each command is a plain struct: add_to() declares its
// options, run() does the work when it was given.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace CLI {
class App;
}

namespace corridor::backend {
struct TreeSnapshot;
}

namespace corridor::cli {

// Options of every command.
struct CommonOptions {
  std::string data_dir;
  bool is_quiet = false;

  void add_to(CLI::App& command);
  [[nodiscard]] std::optional<std::filesystem::path> data_path() const;
  [[nodiscard]] catalog::DataDirs data_dirs() const;
  // One line on standard output, unless quiet.
  void say(const std::string& line) const;
};

// Most cases at a time.
inline constexpr int kMaxJobs = 1024;

// One line on stderr, whatever is in the text.
void print_error(const std::string& text);

// Writes a report on run directories into a folder. Handed in by main(), the one place that knows
// of reports.
using ReportWriter = std::function<Result<void>(const std::vector<std::filesystem::path>& run_dirs,
                                                const std::filesystem::path& out)>;

// A picture (SVG) of a Bayes tree before and after an update. Handed in by main() as well.
using TreeDrawer =
    std::function<std::string(const std::string& title, const backend::TreeSnapshot& before,
                              const backend::TreeSnapshot& after)>;

// The exit code of a command that ran.
using ExitCode = int;

// Fails with a clear Error if the folder of a file to be written does not exist.
Result<void> check_parent_folder(const std::filesystem::path& file);

// Whether two names lead to one file, be it there already or not. An empty name leads nowhere.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

// A seed, all digits of which are used; the Error says the range.
Result<std::uint64_t> seed_from_text(const std::string& text);

// Columns padded with blanks, as wide as needed; the first row is the head.
std::string text_table(std::vector<std::vector<std::string>> rows);

}  // namespace corridor::cli
