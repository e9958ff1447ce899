#include "reports/html/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "reports/escape.hpp"

namespace corridor::html {
namespace {

using reports::Case;
using reports::Cases;

constexpr std::string_view kDirty = "+dirty";
constexpr std::size_t kRevisionDigits = 7;

// What the runner calls a run without a suite.
constexpr std::string_view kOwn = "own";

using Seeds = std::set<std::uint64_t>;

// What one system was asked to do with one data set at one revision.
struct Request {
  std::string revision, suite;
  std::string folder;                  // of the results
  std::string dataset;                 // as the command line takes it
  bool is_found = true;                // the record says where the data are
  std::string system;                  // "karto@as-shipped"
  std::vector<std::string> backends;   // in the order of their names
  std::vector<std::string> overrides;  // "karto.key=value"
  Seeds seeds;
};

// One command: every system on every data set with all back-ends and seeds.
struct Command {
  Request shared;  // its system and data set are those of the lists
  std::vector<std::string> systems, datasets;
};

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
  return suite.empty() ? std::string(kOwn) : reports::file_name_from(suite);
}

std::size_t num_revisions(const Cases& cases, const std::string& suite) {
  std::set<std::string> revisions;
  for (const Case& entry : cases.all()) {
    if (entry.result.suite == suite) revisions.insert(entry.result.git_revision);
  }
  return revisions.size();
}

// A folder holds the cases of one revision, and one data set of a name: a run would replace or
// refuse others.
class Folders {
 public:
  explicit Folders(const Cases& cases) : cases_(cases) {}

  std::string operator()(const Case& entry) {
    const results::RunResult& result = entry.result;
    std::string name = folder_name(result.suite);
    if (num_revisions(cases_, result.suite) > 1) {
      name += fmt::format("-{}",
                          reports::file_name_from(result.git_revision.substr(0, kRevisionDigits)));
      if (result.git_revision.ends_with(kDirty)) name += "-dirty";
    }
    const auto data = std::make_pair(result.data_source, result.dataset);
    auto& known = data_[{name, entry.dataset_given}];
    const auto place = std::find(known.begin(), known.end(), data) - known.begin();
    if (place == std::ssize(known)) known.push_back(data);
    return place == 0 ? name : fmt::format("{}-{}", name, place + 1);
  }

 private:
  using Data = std::pair<std::optional<std::string>, std::string>;
  const Cases& cases_;
  std::map<std::pair<std::string, std::string>, std::vector<Data>> data_;
};

std::string system_choice(const results::RunResult& result) {
  return fmt::format("{}{}{}", shell_quoted(result.system), result.profile.empty() ? "" : "@",
                     result.profile.empty() ? "" : shell_quoted(result.profile));
}

std::vector<std::string> overrides_of(const results::RunResult& result) {
  std::vector<std::string> texts;
  for (const auto& [key, value] : result.overrides.value_or(std::map<std::string, std::string>())) {
    // A back-end's have its name in front already.
    const bool has_owner = key.find('.') != std::string::npos;
    const std::string name = has_owner ? key : result.system + "." + key;
    texts.push_back(shell_quoted(name + "=" + value));
  }
  return texts;
}

auto product_key(const Request& r) {
  return std::tie(r.revision, r.folder, r.suite, r.dataset, r.is_found, r.seeds, r.overrides);
}

// One request per system, back-end and data set, then systems' back-ends joined where everything
// else is the same.
std::vector<Request> requests_of(const Cases& cases) {
  Folders folders(cases);
  std::vector<Request> requests;
  const auto add = [&](Request request, const auto& is_same, const auto& join) {
    const auto found = std::find_if(requests.begin(), requests.end(),
                                    [&](const Request& known) { return is_same(known, request); });
    found == requests.end() ? requests.push_back(std::move(request)) : join(*found, request);
  };
  for (const Case& entry : cases.all()) {
    const results::RunResult& result = entry.result;
    // A suite's data have names; of a log of one's own only the source can be loaded.
    const bool is_found = result.data_source || folder_name(result.suite) != kOwn;
    Request request{result.git_revision,
                    result.suite,
                    folders(entry),
                    shell_quoted(result.data_source.value_or(entry.dataset_given)),
                    is_found,
                    system_choice(result),
                    {},
                    overrides_of(result),
                    {result.data_seed.value_or(result.system_seed)}};
    if (result.backend) request.backends = {shell_quoted(*result.backend)};
    add(
        std::move(request),
        [](const Request& l, const Request& r) {
          return std::tie(l.revision, l.folder, l.suite, l.dataset, l.is_found, l.system,
                          l.overrides, l.backends) == std::tie(r.revision, r.folder, r.suite,
                                                               r.dataset, r.is_found, r.system,
                                                               r.overrides, r.backends);
        },
        [](Request& known, const Request& more) { known.seeds.merge(Seeds(more.seeds)); });
  }
  std::vector<Request> single = std::move(requests);
  requests.clear();
  for (Request& request : single) {
    add(
        std::move(request),
        [](const Request& l, const Request& r) {
          return product_key(l) == product_key(r) && l.system == r.system;
        },
        [](Request& known, const Request& more) {
          known.backends.insert(known.backends.end(), more.backends.begin(), more.backends.end());
          std::sort(known.backends.begin(), known.backends.end());
        });
  }
  return requests;
}

// Systems that share all but their name, then data sets that share all but theirs. A parameter set
// by hand holds for all profiles of its system, which therefore has a command of its own. Without
// back-ends a system takes part in any command.
std::vector<Command> commands_of(const Cases& cases) {
  std::vector<Request> requests = requests_of(cases);
  std::stable_sort(requests.begin(), requests.end(), [](const Request& l, const Request& r) {
    return std::tie(l.revision, l.folder) < std::tie(r.revision, r.folder) ||
           (std::tie(l.revision, l.folder) == std::tie(r.revision, r.folder) &&
            !l.backends.empty() && r.backends.empty());
  });
  std::vector<Command> by_systems;
  for (Request& request : requests) {
    const auto found =
        std::find_if(by_systems.begin(), by_systems.end(), [&](const Command& command) {
          return request.overrides.empty() && product_key(command.shared) == product_key(request) &&
                 (request.backends.empty() || request.backends == command.shared.backends);
        });
    if (found != by_systems.end()) {
      found->systems.push_back(request.system);
    } else {
      by_systems.push_back({request, {request.system}, {request.dataset}});
    }
  }
  std::vector<Command> commands;
  for (Command& command : by_systems) {
    const auto found = std::find_if(commands.begin(), commands.end(), [&](const Command& known) {
      const Request& l = known.shared;
      const Request& r = command.shared;
      return known.systems == command.systems &&
             std::tie(l.revision, l.folder, l.suite, l.is_found, l.seeds, l.overrides,
                      l.backends) == std::tie(r.revision, r.folder, r.suite, r.is_found, r.seeds,
                                              r.overrides, r.backends);
    });
    if (found != commands.end()) {
      found->datasets.push_back(command.shared.dataset);
    } else {
      commands.push_back(std::move(command));
    }
  }
  return commands;
}

std::string options(const std::string& option, const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) text += fmt::format(" {} {}", option, value);
  return text;
}

// First and last of every run of consecutive seeds.
std::vector<std::pair<std::uint64_t, std::uint64_t>> consecutive(const Seeds& seeds) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> all;
  for (const std::uint64_t seed : seeds) {
    if (!all.empty() && all.back().second + 1 == seed) {
      all.back().second = seed;
    } else {
      all.emplace_back(seed, seed);
    }
  }
  return all;
}

std::string run_commands(const Command& command) {
  const Request& shared = command.shared;
  const bool is_own = shared.suite.empty() || shared.suite == kOwn;
  std::string text;
  if (!shared.is_found) {
    text +=
        "# Where these data lie the record does not say: put the path of the log for its name.\n";
  }
  for (const auto& [first, last] : consecutive(shared.seeds)) {
    text += fmt::format(
        "corridor-bench run{} --jobs 1 --seed {} --seeds {} --out {} \\\n    {}{}{} \\\n    {}\n",
        is_own ? "" : fmt::format(" {}", shell_quoted(shared.suite)), first, last - first + 1,
        shared.folder, options("--system", command.systems).substr(1),
        options("--backend", shared.backends), options("--set", shared.overrides),
        options("--dataset", command.datasets).substr(1));
  }
  return text;
}

std::string check_out(const std::string& revision) {
  const bool is_dirty = revision.ends_with(kDirty);
  const std::string clean =
      is_dirty ? revision.substr(0, revision.size() - kDirty.size()) : revision;
  return fmt::format(
      "git checkout {}{}\ncmake --preset release && cmake --build --preset release\n",
      shell_quoted(clean), is_dirty ? "   # plus changes that no revision holds" : "");
}

// Series that only their parameters tell apart, of records that do not say what was set by hand; on
// one line each, whatever is in their names.
std::vector<std::string> variants_by_hand(const Cases& cases) {
  std::set<reports::Series> known;
  for (const Case& entry : cases.all()) {
    if (entry.result.overrides) known.insert(reports::series_of(entry.result));
  }
  std::vector<std::string> labels;
  const std::vector<reports::Series> all = cases.series();
  for (const reports::Series& series : all) {
    const bool has_twin = std::any_of(all.begin(), all.end(), [&](reports::Series other) {
      const bool is_other_set = other.parameters_hash != series.parameters_hash;
      other.parameters_hash = series.parameters_hash;
      return is_other_set && other == series;
    });
    if (!has_twin || known.contains(series)) continue;
    std::string label = cases.label(series);
    std::replace(label.begin(), label.end(), '\n', ' ');
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace

std::string seed_ranges(const Seeds& seeds) {
  std::string text;
  for (const auto& [first, last] : consecutive(seeds)) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format(" to {}", last);
  }
  return text;
}

std::string reproduce_commands(const Cases& cases) {
  std::string text = "# corridor-bench is build/release/bin/corridor-bench.\n";
  std::vector<std::string> folders;
  std::optional<std::string> revision;
  for (const Command& command : commands_of(cases)) {
    if (revision != command.shared.revision) {
      revision = command.shared.revision;
      if (!revision->empty()) text += check_out(*revision);
    }
    text += run_commands(command);
    const std::string& folder = command.shared.folder;
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) {
      folders.push_back(folder);
    }
  }
  text += "\n";
  for (const std::string& label : variants_by_hand(cases)) {
    text += fmt::format("# {}: a run of its own, with --set SYSTEM.key=value\n", label);
  }
  return text + fmt::format("corridor-bench report {} --out report\n", fmt::join(folders, " "));
}

std::string seed_text(const Cases& cases) {
  Seeds data_seeds;
  Seeds system_seeds;
  for (const Case& entry : cases.all()) {
    if (entry.result.data_seed) data_seeds.insert(*entry.result.data_seed);
    system_seeds.insert(entry.result.system_seed);
  }
  if (data_seeds.empty()) return "systems " + seed_ranges(system_seeds) + " (recorded data)";
  if (data_seeds == system_seeds) return seed_ranges(data_seeds) + ", of world and system alike";
  return fmt::format("worlds {}; systems {}", seed_ranges(data_seeds), seed_ranges(system_seeds));
}

}  // namespace corridor::html
