#include "bench/cli/command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <system_error>

#include "bench/runner/printable.hpp"

namespace corridor::cli {
namespace {

// What is wrong with an option's value, as CLI11 asks; empty for nothing.
std::string not_a_folder(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return "";
  return fmt::format(R"("{}" is no folder; expected an existing folder with data sets)", path);
}

}  // namespace

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--data-dir", data_dir, "Folder that is searched for data sets first")
      ->type_name("DIR")
      ->check(not_a_folder);
  command.add_flag("--quiet", is_quiet, "Print results and errors only");
}

std::optional<std::filesystem::path> CommonOptions::data_path() const {
  if (data_dir.empty()) return std::nullopt;
  return std::filesystem::absolute(data_dir);
}

catalog::DataDirs CommonOptions::data_dirs() const {
  return catalog::standard_data_dirs(data_path());
}

void CommonOptions::say(const std::string& line) const {
  if (!is_quiet) std::puts(runner::printable(line).c_str());
}

void print_error(const std::string& text) {
  std::string line = text.substr(0, text.find_last_not_of("\r\n") + 1);
  for (std::size_t at = line.find('\n'); at != std::string::npos; at = line.find('\n', at)) {
    line.replace(at, 1, "; ");
  }
  std::fprintf(stderr, "corridor-bench: %s\n", runner::printable(line).c_str());
}

Result<void> check_parent_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return {};
  return fail(ErrorCode::kNotFound, "the folder does not exist", folder.string(),
              "an existing folder for " + file.filename().string());
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  namespace fs = std::filesystem;
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  const auto full = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  return fs::equivalent(a, b, ignored) || full(a) == full(b);
}

Result<std::uint64_t> seed_from_text(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [parsed_to, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && parsed_to == end) return seed;
  return fail(ErrorCode::kInvalid, text, "--seed", "a whole number from 0 to 18446744073709551615");
}

std::string text_table(std::vector<std::vector<std::string>> rows) {
  std::vector<std::size_t> widths;
  for (auto& row : rows) {
    for (std::string& cell : row) cell = runner::printable(cell);
  }
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(widths[i] - row[i].size() + 2, ' ');
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace corridor::cli
