#include "bench/runner/run_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "bench/results/machine.hpp"
#include "bench/results/result_json.hpp"
#include "bench/results/results_store.hpp"
#include "bench/runner/build_id.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/child_pool.hpp"
#include "bench/runner/earlier_cases.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/progress.hpp"
#include "bench/runner/run_case.hpp"
#include "datasets/formats/atomic_file.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;
using results::CaseStatus;
using results::RunResult;

// Specs handed to children and what they print; gone at the end.
class WorkFolder {
 public:
  static Result<WorkFolder> create(const fs::path& out) {
    try {
      fs::create_directories(out / "runs");
      for (const fs::directory_entry& entry : fs::directory_iterator(out / "runs")) {
        // Left behind by a run that was killed.
        if (entry.path().extension() == ".partial") fs::remove_all(entry.path());
      }
      fs::remove_all(out / ".work");
      fs::create_directory(out / ".work");
    } catch (const fs::filesystem_error& error) {
      return fail(ErrorCode::kUnreadable, error.code().message(), out.string(),
                  "a folder that can be written");
    }
    return WorkFolder(out / ".work");
  }
  WorkFolder(WorkFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  [[nodiscard]] fs::path spec_file(const std::string& id) const { return path_ / (id + ".json"); }
  [[nodiscard]] fs::path output_file(const std::string& id) const { return path_ / (id + ".txt"); }

 private:
  explicit WorkFolder(fs::path path) : path_(std::move(path)) {}
  fs::path path_;
};

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.find_last_of('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

// The record of this very case that an earlier run left, by whatever program.
std::optional<RunResult> finished_record(const fs::path& out, const CaseSpec& spec) {
  const fs::path folder = case_folder(out, case_id(spec));
  if (!fs::exists(folder / "spec.json")) return std::nullopt;
  const Result<CaseSpec> old_spec = read_case_spec(folder / "spec.json");
  Result<RunResult> record = results::read_result(folder / "result.json");
  if (!old_spec || !record || *old_spec != spec) return std::nullopt;
  return std::move(*record);
}

// Why a child ended that left no record of its own.
RunResult record_of_failure(const CaseSpec& spec, const ChildResult& child,
                            const std::string& output, int num_jobs) {
  RunResult record = record_of(spec, num_jobs);
  const std::string line = last_line(output);
  const std::string said = line.empty() ? "" : fmt::format(": {}", line);
  switch (child.end) {
    case ChildEnd::kTimeout:
      record.status = CaseStatus::kTimeout;
      record.status_message = fmt::format("stopped after {} s", spec.limits.time_s);
      break;
    case ChildEnd::kOutOfMemory:
      record.status = CaseStatus::kOutOfMemory;
      record.status_message = fmt::format("more than {} MiB", spec.limits.memory_mib);
      break;
    case ChildEnd::kNotStarted:
      record.status_message = "the process could not be started";
      break;
    case ChildEnd::kCrashed:
      record.status_message =
          fmt::format("crashed with signal {} ({}){}", child.signal, strsignal(child.signal), said);
      break;
    case ChildEnd::kExited:
      if (child.exit_code == kExitBadRequest) record.status = CaseStatus::kBadInput;
      if (child.exit_code == kExitOutOfMemory) record.status = CaseStatus::kOutOfMemory;
      record.status_message =
          line.empty() ? fmt::format("ended with code {}", child.exit_code) : line;
      break;
  }
  return record;
}

// The child's own record, or one made up for it and written in its place.
Result<RunResult> collect(const fs::path& out, const CaseSpec& spec, const ChildResult& child,
                          const std::string& output, int num_jobs) {
  const fs::path folder = case_folder(out, case_id(spec));
  const bool has_record = child.end == ChildEnd::kExited &&
                          (child.exit_code == kExitDone || child.exit_code == kExitNo);
  if (has_record) return results::read_result(folder / "result.json");
  std::error_code ignored;
  fs::remove_all(partial_folder(folder), ignored);
  const RunResult record = record_of_failure(spec, child, output, num_jobs);
  const Result<void> written = write_folder_atomically(folder, [&](const fs::path& temporary) {
    return write_record(temporary, spec, record,
                        fmt::format("case {}\n{}status {}: {}\n", record.case_id, output,
                                    to_text(record.status), record.status_message));
  });
  if (!written) return tl::make_unexpected(written.error());
  return record;
}

bool is_failure(const RunResult& record) {
  return record.status == CaseStatus::kFailed || record.status == CaseStatus::kTimeout ||
         record.status == CaseStatus::kOutOfMemory || record.status == CaseStatus::kBadInput;
}

// Everything a run of a plan has at hand.
class PlanRun {
 public:
  PlanRun(const Plan& plan, const fs::path& out, const RunOptions& options, WorkFolder work,
          results::ResultsStore store)
      : out_(out),
        options_(options),
        work_(std::move(work)),
        store_(std::move(store)),
        progress_(plan.cases.size(), options.is_quiet, options.is_terminal,
                  (out / "log.txt").string()) {
    summary_.num_cases = plan.cases.size();
    for (const std::string& line : plan.skipped) progress_.note(line);
  }

  Result<RunSummary> run(const std::vector<CaseSpec>& cases, const EarlierCases& earlier) {
    say_what_is_here(earlier);
    if (const Result<void> put = store_.put(results::this_machine()); !put) {
      return tl::make_unexpected(put.error());
    }
    const std::vector<CaseSpec> waiting = options_.is_resumed ? keep_finished(cases) : cases;
    if (const Result<void> started = start(waiting); !started) {
      return tl::make_unexpected(started.error());
    }
    if (problem_) return tl::make_unexpected(*problem_);
    return summary_;
  }

 private:
  void say_what_is_here(const EarlierCases& earlier) {
    summary_.num_earlier = earlier.num_cases;
    if (earlier.num_cases == 0) return;
    const bool is_one = earlier.num_cases == 1;
    progress_.note(fmt::format(
        "{}: {} {} of earlier runs (suite {}) {} here and {} in the report too; --out names "
        "another folder",
        out_.string(), earlier.num_cases, is_one ? "case" : "cases",
        fmt::join(earlier.suites, ", "), is_one ? "stays" : "stay", is_one ? "is" : "are"));
  }

  // Keeps what this build of the program has run; the other cases.
  std::vector<CaseSpec> keep_finished(const std::vector<CaseSpec>& cases) {
    const std::optional<std::string> build = build_id();
    std::vector<CaseSpec> waiting;
    std::size_t num_outdated = 0;
    for (const CaseSpec& spec : cases) {
      const std::optional<RunResult> record = finished_record(out_, spec);
      if (record && build && record->build_id == build) {
        ++summary_.num_kept;
        keep(*record, 0);
        continue;
      }
      if (record) ++num_outdated;
      waiting.push_back(spec);
    }
    if (num_outdated > 0) {
      progress_.note(fmt::format("{} finished {} not kept: run by another build of the program",
                                 num_outdated, num_outdated == 1 ? "case is" : "cases are"));
    }
    return waiting;
  }

  Result<void> start(const std::vector<CaseSpec>& waiting) {
    // What the times of a case are disturbed by.
    num_jobs_ = std::clamp(static_cast<int>(waiting.size()), 1, options_.num_jobs);
    std::vector<ChildTask> tasks;
    for (const CaseSpec& spec : waiting) {
      const Result<ChildTask> task = task_of(spec);
      if (!task) return tl::make_unexpected(task.error());
      tasks.push_back(*task);
    }
    const auto finished = [&](std::size_t index, const ChildResult& child) {
      const std::string output = read_text(tasks[index].output_file);
      const Result<RunResult> record = collect(out_, waiting[index], child, output, num_jobs_);
      if (record)
        keep(*record, child.wall_s);
      else
        problem_ = record.error();
      return !problem_.has_value();
    };
    summary_.is_interrupted = !run_children(tasks, num_jobs_, finished, [&] { progress_.tick(); });
    return {};
  }

  Result<ChildTask> task_of(const CaseSpec& spec) const {
    const std::string id = case_id(spec);
    const std::string text = to_json(spec);
    const auto written =
        formats::write_file_atomically(work_.spec_file(id), std::string_view(text));
    if (!written) return tl::make_unexpected(written.error());
    ChildTask task;
    task.command = {options_.executable.string(),
                    "run-case",
                    work_.spec_file(id).string(),
                    "--out",
                    out_.string(),
                    "--quiet",
                    "--jobs",
                    std::to_string(num_jobs_)};
    if (options_.data_dir) {
      task.command.insert(task.command.end(), {"--data-dir", options_.data_dir->string()});
    }
    task.output_file = work_.output_file(id);
    task.time_limit_s = spec.limits.time_s;
    task.memory_limit_mib = spec.limits.memory_mib;
    return task;
  }

  void keep(const RunResult& record, double wall_s) {
    if (is_failure(record)) ++summary_.num_failed;
    if (const Result<void> put = store_.put(std::vector{record}); !put) problem_ = put.error();
    progress_.case_done(record, wall_s);
  }

  const fs::path& out_;
  const RunOptions& options_;
  WorkFolder work_;
  results::ResultsStore store_;
  Progress progress_;
  RunSummary summary_;
  int num_jobs_ = 1;
  std::optional<Error> problem_;  // of the harness itself: a full disk
};

}  // namespace

Result<RunSummary> run_plan(const Plan& plan, const FolderLock& out, const RunOptions& options) {
  const fs::path& folder = out.folder();
  Result<results::ResultsStore> store = results::ResultsStore::open(folder / "results.sqlite");
  if (!store) return tl::make_unexpected(store.error());
  const Result<EarlierCases> earlier = earlier_cases(*store, plan.cases, folder);
  if (!earlier) return tl::make_unexpected(earlier.error());
  Result<WorkFolder> work = WorkFolder::create(folder);
  if (!work) return tl::make_unexpected(work.error());
  // A page that lacks what is about to be run would look final if this run were killed.
  std::error_code ignored;
  fs::remove(folder / "index.html", ignored);
  return PlanRun(plan, folder, options, std::move(*work), std::move(*store))
      .run(plan.cases, *earlier);
}

}  // namespace corridor::runner
