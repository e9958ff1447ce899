#include "reports/html/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/escape.hpp"

namespace corridor::html {
namespace {

using reports::Case;
using reports::Cases;

constexpr std::string_view kDirty = "+dirty";

// What the runner calls a run without a suite.
constexpr std::string_view kOwn = "own";

// What was asked of one suite at one revision.
struct Request {
  std::set<std::string> systems, datasets;
  std::map<std::string, std::set<std::string>> backends;  // by system
  std::set<std::uint64_t> data_seeds, system_seeds;
};
using Requests = std::map<std::string, std::map<std::string, Request>>;  // by revision, by suite

// A name in single quotes as a POSIX shell reads it.
std::string shell_quoted(const std::string& text) {
  if (!text.empty() && reports::file_name_from(text) == text) return text;
  std::string quoted = "'";
  for (const char character : text) {
    if (character == '\'') {
      quoted += "'\\''";
    } else {
      quoted += character;
    }
  }
  quoted += '\'';
  return quoted;
}

std::string folder_name(const std::string& suite) {
  return suite.empty() ? std::string(kOwn) : shell_quoted(suite);
}

// "1 to 5, 9".
std::string ranges(const std::set<std::uint64_t>& seeds) {
  std::string text;
  for (auto it = seeds.begin(); it != seeds.end();) {
    const std::uint64_t first = *it;
    std::uint64_t last = first;
    while (++it != seeds.end() && *it == last + 1) last = *it;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format(" to {}", last);
  }
  return text;
}

Requests requests_of(const Cases& cases) {
  Requests requests;
  for (const Case& entry : cases.all()) {
    const results::RunResult& result = entry.result;
    Request& request = requests[result.git_revision][result.suite];
    request.systems.insert(fmt::format("{}{}{}", shell_quoted(result.system),
                                       result.profile.empty() ? "" : "@",
                                       result.profile.empty() ? "" : shell_quoted(result.profile)));
    if (result.backend) request.backends[result.system].insert(shell_quoted(*result.backend));
    request.datasets.insert(shell_quoted(entry.dataset_given));
    if (result.data_seed) request.data_seeds.insert(*result.data_seed);
    request.system_seeds.insert(result.system_seed);
  }
  return requests;
}

std::string options(const std::string& option, const std::set<std::string>& values) {
  std::string text;
  for (const std::string& value : values) text += fmt::format(" {} {}", option, value);
  return text;
}

// Every system's own back-end is what a run takes without being told.
std::set<std::string> asked_backends(const Request& request) {
  std::set<std::string> asked;
  for (const auto& [system, backends] : request.backends) {
    if (backends.size() > 1) asked.insert(backends.begin(), backends.end());
  }
  return asked;
}

std::string run_command(const std::string& suite, const Request& request) {
  const auto& seeds = request.data_seeds.empty() ? request.system_seeds : request.data_seeds;
  const std::string name = folder_name(suite);
  const bool has_gaps = *seeds.rbegin() - *seeds.begin() >= seeds.size();
  return fmt::format(
      "{}corridor-bench run{} --jobs 1 --seed {} --seeds {} --out {} \\\n    {}{} \\\n    {}\n",
      has_gaps ? fmt::format("# seeds {} only:\n", ranges(seeds)) : "",
      name == kOwn ? "" : fmt::format(" {}", name), *seeds.begin(), seeds.size(), name,
      options("--system", request.systems).substr(1), options("--backend", asked_backends(request)),
      options("--dataset", request.datasets).substr(1));
}

std::string check_out(const std::string& revision) {
  const bool is_dirty = revision.ends_with(kDirty);
  const std::string clean =
      is_dirty ? revision.substr(0, revision.size() - kDirty.size()) : revision;
  return fmt::format(
      "git checkout {}{}\ncmake --preset release && cmake --build --preset release\n",
      shell_quoted(clean), is_dirty ? "   # plus changes that no revision holds" : "");
}

// Series that only their parameters tell apart; on one line each, whatever is in their names.
std::vector<std::string> variants_by_hand(const Cases& cases) {
  std::vector<std::string> labels;
  const std::vector<reports::Series> all = cases.series();
  for (const reports::Series& series : all) {
    const bool has_twin = std::any_of(all.begin(), all.end(), [&](reports::Series other) {
      const bool is_other_set = other.parameters_hash != series.parameters_hash;
      other.parameters_hash = series.parameters_hash;
      return is_other_set && other == series;
    });
    if (!has_twin) continue;
    std::string label = cases.label(series);
    std::replace(label.begin(), label.end(), '\n', ' ');
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace

std::string reproduce_commands(const Cases& cases) {
  std::string text =
      "# corridor-bench is build/release/bin/corridor-bench. Parameters set by hand (the tables "
      "above\n"
      "# list every value) are set again with --set SYSTEM.key=value.\n";
  std::set<std::string> folders;
  for (const auto& [revision, by_suite] : requests_of(cases)) {
    if (!revision.empty()) text += check_out(revision);
    for (const auto& [suite, request] : by_suite) {
      text += run_command(suite, request);
      folders.insert(folder_name(suite));
    }
    text += "\n";
  }
  for (const std::string& label : variants_by_hand(cases)) {
    text += fmt::format("# {}: a run of its own, with --set\n", label);
  }
  text += "corridor-bench report";
  for (const std::string& folder : folders) text += fmt::format(" {}", folder);
  return text + " --out report\n";
}

std::string seed_text(const Cases& cases) {
  std::set<std::uint64_t> data_seeds;
  std::set<std::uint64_t> system_seeds;
  for (const Case& entry : cases.all()) {
    if (entry.result.data_seed) data_seeds.insert(*entry.result.data_seed);
    system_seeds.insert(entry.result.system_seed);
  }
  if (data_seeds.empty()) return "systems " + ranges(system_seeds) + " (recorded data)";
  if (data_seeds == system_seeds) return ranges(data_seeds) + ", of world and system alike";
  return fmt::format("worlds {}; systems {}", ranges(data_seeds), ranges(system_seeds));
}

}  // namespace corridor::html
