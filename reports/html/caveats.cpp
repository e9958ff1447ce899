#include "reports/html/caveats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "reports/html/reproduce.hpp"
#include "reports/tables/paper_world.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/timing.hpp"
#include "slam/core/counted.hpp"

namespace corridor::html {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

bool has_system(const Cases& cases, const std::set<std::string>& names) {
  const auto& all = cases.all();
  return std::any_of(all.begin(), all.end(),
                     [&](const Case& entry) { return names.contains(entry.result.system); });
}

bool is_simulated(const Cases& cases) {
  const auto& all = cases.all();
  return std::any_of(all.begin(), all.end(),
                     [](const Case& entry) { return entry.result.data_seed.has_value(); });
}

// Seeds below are for development; a report's own worlds have others.
constexpr std::uint64_t kFirstReportSeed = 1000;

// Of worlds that a system was developed on, its errors promise nothing.
void append_seeds(const Cases& cases, std::vector<std::string>& sentences) {
  std::set<std::uint64_t> development;
  std::size_t num_simulated = 0;
  std::size_t num_development = 0;
  for (const Case& entry : cases.all()) {
    if (!entry.result.data_seed) continue;
    ++num_simulated;
    if (*entry.result.data_seed >= kFirstReportSeed) continue;
    ++num_development;
    development.insert(*entry.result.data_seed);
  }
  if (num_development > 0) {
    sentences.push_back(fmt::format(
        "Warning: development seeds are in this report. Seeds below {} are for development, and {} "
        "of {} simulated cases have one ({}): errors in worlds that a system was developed on say "
        "little about new ones.",
        kFirstReportSeed, num_development, num_simulated, seed_ranges(development)));
  } else if (num_simulated > 0 && has_system(cases, {"fusion"})) {
    sentences.emplace_back(
        "fusion was developed on worlds of the same simulator, with other seeds than these; no "
        "rival was adapted to it but by its profiles tuned and dense.");
  }
}

// Of records that do not say what was set by hand, a label cannot either.
void append_unknown_overrides(const Cases& cases, std::vector<std::string>& sentences) {
  const auto& all = cases.all();
  const auto num_unknown = std::count_if(all.begin(), all.end(),
                                         [](const Case& entry) { return !entry.result.overrides; });
  if (num_unknown == 0) return;
  sentences.push_back(
      fmt::format("The records of {} of {} cases do not say which parameters were set by hand: "
                  "compare the list of parameters with the profile before calling one shipped.",
                  num_unknown, all.size()));
}

// Rivals with the parameters their users get, and what was changed in others.
void append_configuration(const Cases& cases, std::vector<std::string>& sentences) {
  std::set<std::string> shipped;
  std::set<std::string> tuned;
  std::set<std::string> dense;
  std::set<std::string> shipped_for_a_log;
  for (const Series& series : cases.series()) {
    if (!series.overrides.empty()) continue;
    if (series.profile == "as-shipped") shipped.insert(series.system);
    if (series.profile == "as-shipped-icp") shipped_for_a_log.insert(series.system);
    if (series.profile == "tuned") tuned.insert(series.system);
    if (series.profile == "dense") dense.insert(series.system);
  }
  if (!shipped.empty()) {
    sentences.push_back(fmt::format(
        "Profile as-shipped is what users of the original programs get: {}. What else was "
        "run is named in the label: a profile, or what was set by hand (set: ...). No such "
        "profile was tuned for these data.",
        fmt::join(shipped, ", ")));
  }
  if (!shipped_for_a_log.empty()) {
    sentences.push_back(fmt::format(
        "Profile as-shipped-icp is what MRPT ships for the log of the Intel Research Lab: {}. On "
        "intel its authors have tuned it.",
        fmt::join(shipped_for_a_log, ", ")));
  }
  if (!tuned.empty()) {
    sentences.push_back(fmt::format(
        "Profile tuned is the best of a random search on development worlds of the paper's "
        "corridor, with the same budget for every system that has one: {} "
        "(bench/tuning/README.md). It says little about other places.",
        fmt::join(tuned, ", ")));
  }
  if (!dense.empty()) {
    sentences.push_back(fmt::format(
        "Profile dense was chosen by hand, on logs of this corridor and on recorded ones, so that "
        "it holds where the shipped values get lost: {} (baselines/mrpt/README.md). No search "
        "with a budget was made for it.",
        fmt::join(dense, ", ")));
  }
  append_unknown_overrides(cases, sentences);
  append_seeds(cases, sentences);
  if (has_system(cases, {"gmapping", "karto"})) {
    sentences.emplace_back(
        "gmapping and karto are reimplementations from papers and measured behaviour, not the "
        "original programs.");
  }
}

// [DoDuc2024] gives no data sheet of its LiDAR.
void append_world(const Cases& cases, std::vector<std::string>& sentences) {
  for (const std::string& dataset : cases.datasets()) {
    if (!tables::is_paper_world(cases, dataset)) continue;
    sentences.push_back(fmt::format(
        "{}: the paper does not say how far its LiDAR sees. The range was chosen so that karto's "
        "position error comes out near the paper's, so that agreement is no evidence.",
        dataset));
  }
}

void append_sensors(const Cases& cases, std::vector<std::string>& sentences) {
  if (has_system(cases, {"fusion", "fusion-paper", "dead-reckoning-gyro"})) {
    sentences.emplace_back(
        "Only fusion, fusion-paper, dead-reckoning-gyro and the profiles gyro-odometry read the "
        "IMU; all others get wheels and "
        "LiDAR, as their programs do (dead-reckoning the wheels alone). dead-reckoning-gyro, "
        "wheels "
        "and gyro without LiDAR, is the floor: what it reaches owes nothing to scan matching.");
  }
  if (is_simulated(cases)) {
    sentences.emplace_back(
        "Simulator and estimators share the form of their error models (constant wheel scale, "
        "white noise and, where a scenario states no drift, constant biases): systems that "
        "estimate these are favoured over what a real robot would give them.");
  }
}

void append_statistics(const Cases& cases, std::vector<std::string>& sentences) {
  const std::size_t num_pairs = tables::comparison_table(cases).rows.size();
  if (num_pairs > 1) {
    sentences.push_back(fmt::format(
        "Comparisons are pairwise with 95 % each and not corrected for their number: with {} pairs "
        "(table of paired factors), a few intervals may miss 1 by chance. An interval just beside "
        "1 "
        "is weak evidence.",
        num_pairs));
  }
}

// A collapsed map and a right one look alike in every table.
void append_unscored(const Cases& cases, std::vector<std::string>& sentences) {
  for (const std::string& dataset : cases.datasets()) {
    if (tables::is_scored(cases, dataset)) continue;
    sentences.push_back(fmt::format(
        "{}: not scored: no true poses, no relations. That a system ended there does not say that "
        "its map is right.",
        dataset));
  }
}

// What the runner noted about the scores, once for all cases that it holds for.
void append_score_notes(const Cases& cases, std::vector<std::string>& sentences) {
  std::map<std::pair<std::string, std::string>, std::size_t> num_cases;
  for (const Case& entry : cases.all()) {
    for (const std::string& note : entry.result.notes) ++num_cases[{entry.result.dataset, note}];
  }
  for (const auto& [key, num] : num_cases) {
    sentences.push_back(fmt::format("{}: {} ({})", key.first, key.second, counted(num, "case")));
  }
}

void append_provenance(const Cases& cases, std::vector<std::string>& sentences) {
  if (cases.num_set_aside() > 0) {
    sentences.push_back(fmt::format(
        "{} record{} set aside: another one of the same system, parameters, revision, data and "
        "seeds is newer.",
        cases.num_set_aside(), cases.num_set_aside() == 1 ? " was" : "s were"));
  }
  std::set<std::string> revisions;
  for (const Case& entry : cases.all()) revisions.insert(entry.result.git_revision);
  if (revisions.size() > 1) {
    sentences.push_back(
        fmt::format("The cases are from {} revisions of the code: a difference between systems may "
                    "be one between revisions.",
                    revisions.size()));
  }
  if (std::any_of(revisions.begin(), revisions.end(),
                  [](const std::string& revision) { return revision.ends_with("+dirty"); })) {
    sentences.emplace_back(
        "A revision ending in +dirty had changes that no revision holds: these numbers cannot be "
        "made again from it with certainty.");
  }
}

}  // namespace

std::vector<std::string> caveats(const Cases& cases) {
  std::vector<std::string> sentences;
  append_configuration(cases, sentences);
  append_sensors(cases, sentences);
  append_world(cases, sentences);
  append_unscored(cases, sentences);
  append_statistics(cases, sentences);
  for (const std::string& note : reports::timing_notes(cases))
    sentences.push_back(fmt::format("Times: {}", note));
  append_score_notes(cases, sentences);
  append_provenance(cases, sentences);
  return sentences;
}

}  // namespace corridor::html
