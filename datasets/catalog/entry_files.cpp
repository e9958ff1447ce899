#include "datasets/catalog/entry_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::catalog {
namespace {

using formats::LogFormat;

constexpr std::array<LogFormat, 5> kLogFormats = {
    LogFormat::kCarmen, LogFormat::kRawlog, LogFormat::kLcm, LogFormat::kTicks, LogFormat::kRosbag};

bool is_log_format(const std::string& format) {
  return std::any_of(kLogFormats.begin(), kLogFormats.end(),
                     [&](LogFormat known) { return formats::to_text(known) == format; });
}

bool fits_log(const std::filesystem::path& path, const std::string& format) {
  const auto by_name = formats::format_from_suffix(path);
  if (!by_name) return false;
  const std::string name = path.filename().string();
  // CARMEN's or an LCM event log: its bytes tell, when it is read.
  const bool may_be_lcm = name.ends_with(".log") || name.ends_with(".log.gz");
  return formats::to_text(*by_name) == format || (may_be_lcm && format == "lcm");
}

bool fits_graph(const std::filesystem::path& path, const std::string& format) {
  const auto by_name = formats::graph_format_from_suffix(path);
  return by_name && (*by_name == formats::GraphFormat::kG2o) == (format == "g2o");
}

void check_graph(const CatalogEntry& entry, std::vector<EntryProblem>& problems) {
  const std::string graph = entry.files.front().path.string();
  if (!fits_graph(graph, entry.format)) {
    problems.push_back({"format", fmt::format("{} is no {} by its name; expected one that ends in "
                                              ".g2o (g2o), .graph or .toro (toro)",
                                              graph, entry.format)});
  }
  if (entry.files.size() > 1) problems.push_back({"files", "expected one file of a pose graph"});
  if (entry.truth != TruthKind::kNone) {
    problems.push_back({"truth", "expected none of a pose graph"});
  }
}

// What is listed must be what `truth` says, no more and no less.
void check_truth(const CatalogEntry& entry, std::vector<EntryProblem>& problems) {
  const std::vector<std::string> sidecars = entry.sidecars();
  const auto check = [&](const char* suffix, TruthKind kind) {
    const bool is_listed = std::find(sidecars.begin(), sidecars.end(), suffix) != sidecars.end();
    if (is_listed == (entry.truth == kind)) return;
    const std::string file = formats::sidecar_of(entry.files.front().path, suffix).string();
    problems.push_back(
        {"truth", is_listed ? fmt::format("{}, but {} is listed; expected {}", to_text(entry.truth),
                                          file, to_text(kind))
                            : fmt::format("{}; expected {} among the files", to_text(kind), file)});
  };
  check(".tum", TruthKind::kTum);
  check(".relations", TruthKind::kRelations);
  if (entry.truth == TruthKind::kReference && entry.format != "lcm") {
    problems.push_back({"truth", "only lcm logs hold a reference"});
  }
}

void check_log(const CatalogEntry& entry, std::vector<EntryProblem>& problems) {
  const std::filesystem::path& log = entry.files.front().path;
  if (!fits_log(log, entry.format)) {
    const auto by_name = formats::format_from_suffix(log);
    problems.push_back(
        {"format", fmt::format("{} is {} by its name, not {}", log.string(),
                               by_name ? formats::to_text(*by_name) : "no log", entry.format)});
  }
  if (entry.sidecars().size() + 1 != entry.files.size()) {
    problems.push_back(
        {"files", fmt::format("expected the log and, beside it, once each: {} with one of {}",
                              formats::sidecar_of(log, "").string(),
                              fmt::join(formats::kSidecarSuffixes, " "))});
  }
  check_truth(entry, problems);
}

}  // namespace

std::vector<EntryProblem> unfit_files(const CatalogEntry& entry) {
  std::vector<EntryProblem> problems;
  if (entry.is_graph()) {
    check_graph(entry, problems);
  } else if (is_log_format(entry.format)) {
    check_log(entry, problems);
  } else {
    problems.push_back(
        {"format", fmt::format("\"{}\"; expected carmen, rawlog, lcm, ticks or rosbag, or g2o or "
                               "toro of a pose graph",
                               entry.format)});
  }
  return problems;
}

}  // namespace corridor::catalog
