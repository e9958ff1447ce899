#include "reports/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "bench/results/result_json.hpp"
#include "bench/results/results_store.hpp"
#include "reports/series_labels.hpp"

namespace corridor::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 10> kOrder = {
    "dead-reckoning", "dead-reckoning-gyro", "mrpt-icp", "mrpt-rbpf",   "gmapping",
    "karto",          "fusion-paper",        "fusion",   "graph-batch", "graph-incremental"};

// The profile of what a program's users get; others change something and are named after it.
constexpr std::string_view kShippedProfile = "as-shipped";

std::size_t rank(const std::string& system) {
  return static_cast<std::size_t>(std::find(kOrder.begin(), kOrder.end(), system) - kOrder.begin());
}

auto sort_key(const Series& series) {
  return std::make_tuple(rank(series.system), series.system, !series.overrides.empty(),
                         series.profile != kShippedProfile, series.profile, series.backend,
                         series.overrides, series.parameters_hash, series.git_revision);
}

auto sort_key(const Case& entry) {
  const results::RunResult& r = entry.result;
  return std::make_tuple(r.dataset, sort_key(series_of(r)), r.data_seed, r.system_seed, r.case_id);
}

constexpr std::size_t kDigestDigits = 6;

// A case that failed before its data were known stays with the name, which tells it from nothing.
void separate_data(std::vector<Case>& cases) {
  std::map<std::string, std::set<std::string>> digests;
  for (Case& entry : cases) {
    entry.dataset_given = entry.result.dataset;
    const std::string digest = entry.result.data_digest.value_or("");
    if (!digest.empty()) digests[entry.dataset_given].insert(digest);
  }
  for (Case& entry : cases) {
    const std::string digest = entry.result.data_digest.value_or("");
    if (digest.empty() || digests[entry.dataset_given].size() < 2) continue;
    entry.result.dataset = fmt::format("{} (#{})", entry.dataset_given,
                                       std::string_view(digest).substr(0, kDigestDigits));
  }
}

// When the record was written; nothing known: before all others.
fs::file_time_type written_at(const Case& entry) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(entry.dir / "result.json", error);
  return error ? fs::file_time_type::min() : time;
}

// Keeps the newest record of every experiment; how many it left out.
std::size_t set_aside_repeats(std::vector<Case>& cases) {
  std::map<std::tuple<Series, World, std::uint64_t, int>, std::size_t> place;
  std::vector<Case> kept;
  for (Case& entry : cases) {
    const auto [found, is_new] =
        place.emplace(std::make_tuple(series_of(entry.result), world_of(entry.result),
                                      entry.result.system_seed, entry.result.threads),
                      kept.size());
    if (is_new) {
      kept.push_back(std::move(entry));
    } else if (written_at(entry) >= written_at(kept[found->second])) {
      kept[found->second] = std::move(entry);
    }
  }
  const std::size_t num_left_out = cases.size() - kept.size();
  cases = std::move(kept);
  return num_left_out;
}

Result<std::vector<results::RunResult>> read_json_files(const fs::path& run_dir) {
  std::vector<results::RunResult> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run_dir / "runs", error)) {
    const fs::path path = entry.path() / "result.json";
    if (!fs::exists(path)) continue;
    auto result = results::read_result(path);
    if (!result) return tl::make_unexpected(result.error());
    if (result->case_id.empty()) result->case_id = entry.path().filename().string();
    found.push_back(std::move(*result));
  }
  return found;
}

Result<void> read_run_dir(const fs::path& run_dir, std::vector<Case>& cases,
                          std::vector<results::Machine>& machines) {
  if (!fs::is_directory(run_dir)) {
    return fail(ErrorCode::kNotFound, "no such directory", run_dir.string(), "what a run left");
  }
  Result<std::vector<results::RunResult>> found;
  if (const fs::path path = run_dir / "results.sqlite"; fs::exists(path)) {
    const auto store = results::ResultsStore::open_read_only(path);
    if (!store) return tl::make_unexpected(store.error());
    const auto stored_machines = store->read_machines();
    if (!stored_machines) return tl::make_unexpected(stored_machines.error());
    machines.insert(machines.end(), stored_machines->begin(), stored_machines->end());
    found = store->read_all();
  } else {
    found = read_json_files(run_dir);
  }
  if (!found) return tl::make_unexpected(found.error());
  if (found->empty()) {
    return fail(ErrorCode::kInvalid, "no result in this directory", run_dir.string(),
                "results.sqlite or runs/*/result.json with at least one case");
  }
  for (results::RunResult& result : *found) {
    const fs::path dir = run_dir / "runs" / result.case_id;
    cases.push_back({std::move(result), dir});
  }
  return {};
}

}  // namespace

bool is_of_graph(const results::RunResult& result) { return result.data_kind == "graph"; }

Series series_of(const results::RunResult& result) {
  std::string overrides;
  for (const auto& [key, value] : result.overrides.value_or(std::map<std::string, std::string>())) {
    overrides += fmt::format("{}{}={}", overrides.empty() ? "" : ", ", key, value);
  }
  return {result.system,          result.profile,      result.backend.value_or(""),
          result.parameters_hash, result.git_revision, overrides};
}

World world_of(const results::RunResult& result) {
  return {result.dataset, result.data_seed, result.data_seed ? 0 : result.system_seed};
}

Cases::Cases(std::vector<Case> cases, std::vector<results::Machine> machines,
             std::vector<fs::path> run_dirs)
    : cases_(std::move(cases)), machines_(std::move(machines)), run_dirs_(std::move(run_dirs)) {
  separate_data(cases_);
  num_set_aside_ = set_aside_repeats(cases_);
  std::stable_sort(cases_.begin(), cases_.end(), [](const Case& left, const Case& right) {
    return sort_key(left) < sort_key(right);
  });
  std::sort(machines_.begin(), machines_.end(),
            [](const auto& left, const auto& right) { return left.machine_id < right.machine_id; });
  machines_.erase(std::unique(machines_.begin(), machines_.end()), machines_.end());
  labels_ = series_labels(cases_);
}

Cases Cases::only(const std::function<bool(const results::RunResult&)>& is_wanted) const {
  Cases part = *this;
  std::erase_if(part.cases_, [&](const Case& entry) { return !is_wanted(entry.result); });
  part.labels_ = series_labels(part.cases_);
  return part;
}

std::vector<std::string> Cases::datasets() const {
  std::set<std::string> names;
  for (const Case& entry : cases_) names.insert(entry.result.dataset);
  return {names.begin(), names.end()};
}

std::vector<Series> Cases::series() const {
  std::set<Series> unique;
  for (const Case& entry : cases_) unique.insert(series_of(entry.result));
  std::vector<Series> sorted(unique.begin(), unique.end());
  std::sort(sorted.begin(), sorted.end(), [](const Series& left, const Series& right) {
    return sort_key(left) < sort_key(right);
  });
  return sorted;
}

std::vector<const Case*> Cases::of(const std::string& dataset) const {
  std::vector<const Case*> found;
  for (const Case& entry : cases_) {
    if (entry.result.dataset == dataset) found.push_back(&entry);
  }
  return found;
}

std::vector<const Case*> Cases::of(const std::string& dataset, const Series& series) const {
  std::vector<const Case*> found = of(dataset);
  std::erase_if(found, [&](const Case* entry) { return series_of(entry->result) != series; });
  return found;
}

Result<Cases> load_cases(const std::vector<fs::path>& run_dirs) {
  if (run_dirs.empty()) {
    return fail(ErrorCode::kInvalid, "nothing to report on", "run directories", "at least one");
  }
  std::vector<Case> cases;
  std::vector<results::Machine> machines;
  for (const fs::path& run_dir : run_dirs) {
    if (auto read = read_run_dir(run_dir, cases, machines); !read) {
      return tl::make_unexpected(read.error());
    }
  }
  return Cases(std::move(cases), std::move(machines), run_dirs);
}

}  // namespace corridor::reports
