#include "bench/runner/run_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "bench/results/result_json.hpp"
#include "bench/results/results_store.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/run_case.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;
using results::CaseStatus;

CaseSpec spec_of(std::uint64_t seed) {
  CaseSpec spec;
  spec.suite = "test";
  spec.system = "karto";
  spec.profile = "as-shipped";
  spec.backend = "levenberg";
  spec.dataset = "paper-corridor";
  spec.data_source = "paper-corridor";
  spec.data_seed = seed;
  spec.system_seed = seed;
  spec.limits = {20, 200};
  return spec;
}

// Runs cases with a shell script in the program's place, so that each way of ending can be had at
// will.
class RunPlanTest : public ::testing::Test {
 protected:
  // `script` is called as: script run-case SPEC.json --out OUT --quiet
  Result<RunSummary> run(const std::vector<CaseSpec>& cases, const std::string& script,
                         bool is_resumed = false) {
    const fs::path program = folder_.write("program.sh", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    RunOptions options;
    options.executable = program;
    options.is_resumed = is_resumed;
    options.is_quiet = true;
    options.num_jobs = num_jobs_;
    const Result<FolderLock> lock = FolderLock::take(out());
    if (!lock) return tl::make_unexpected(lock.error());
    return run_plan({cases, {}}, *lock, options);
  }

  [[nodiscard]] std::vector<results::RunResult> stored() const {
    return results::ResultsStore::open_read_only(out() / "results.sqlite")->read_all().value();
  }

  // The one record of the store, which must be that of result.json.
  [[nodiscard]] results::RunResult only_record() const {
    const auto records = stored();
    EXPECT_EQ(records.size(), 1U);
    const auto file = results::read_result(case_folder(out(), records[0].case_id) / "result.json");
    EXPECT_EQ(results::to_json(file.value()), results::to_json(records[0]));
    return records[0];
  }

  [[nodiscard]] std::string text_in(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  [[nodiscard]] fs::path out() const { return folder_ / "out"; }

  testing::ScratchFolder folder_;
  int num_jobs_ = 1;
};

TEST_F(RunPlanTest, MakesARowOfACrash) {
  const auto summary = run({spec_of(1)}, "echo last words >&2; kill -SEGV $$");
  ASSERT_TRUE(summary.has_value());
  EXPECT_EQ(summary->num_failed, 1U);
  const results::RunResult record = only_record();
  EXPECT_EQ(record.status, CaseStatus::kFailed);
  EXPECT_NE(record.status_message.find("signal 11"), std::string::npos);
  EXPECT_NE(record.status_message.find("last words"), std::string::npos);
  EXPECT_EQ(record.system, "karto");
  EXPECT_FALSE(record.final_scores.position_rmse_m.has_value());
  EXPECT_FALSE(record.parameters.empty());
}

TEST_F(RunPlanTest, MakesARowOfATimeOut) {
  CaseSpec spec = spec_of(1);
  spec.limits.time_s = 0.2;
  ASSERT_TRUE(run({spec}, "exec sleep 60").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kTimeout);
  EXPECT_EQ(only_record().status_message, "stopped after 0.2 s");
}

TEST_F(RunPlanTest, MakesARowOfTooMuchMemory) {
  CaseSpec spec = spec_of(1);
  spec.limits.memory_mib = 64;
  ASSERT_TRUE(run({spec}, "x=0123456789abcdef; while :; do x=$x$x; done").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kOutOfMemory);
}

TEST_F(RunPlanTest, MakesARowOfBadInputWithTheLineThatSaysWhy) {
  ASSERT_TRUE(
      run({spec_of(1)}, "echo 'corridor-bench: log.clf: truncated' >&2; exit 2").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kBadInput);
  EXPECT_EQ(only_record().status_message, "corridor-bench: log.clf: truncated");
}

TEST_F(RunPlanTest, MakesAFailureNotBadInputOfResultsThatCannotBeWritten) {
  ASSERT_TRUE(run({spec_of(1)}, "echo 'map.pgm: no space left' >&2; exit 4").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kFailed);
  EXPECT_EQ(only_record().status_message, "map.pgm: no space left");
}

TEST_F(RunPlanTest, StopsAtTheFirstRecordThatCannotBeKept) {
  // A file where the folders of the cases should be.
  const auto stopped = run({spec_of(1), spec_of(2), spec_of(3)},
                           "echo x >> \"$(dirname \"$0\")/calls\"; rm -rf \"$4/runs\"; "
                           "echo > \"$4/runs\"; exit 2");
  EXPECT_FALSE(stopped.has_value());
  EXPECT_EQ(text_in("calls"), "x\n");
}

TEST_F(RunPlanTest, CountsTheCasesOfOtherRunsThatStayInTheFolder) {
  const auto first = run({spec_of(1), spec_of(2)}, "exit 2");
  EXPECT_EQ(first->num_earlier, 0U);
  CaseSpec changed = spec_of(2);
  changed.suite = "another";
  const auto second = run({spec_of(1), changed}, "exit 2");
  EXPECT_EQ(second->num_earlier, 1U) << "seed 2 of the first suite";
  EXPECT_NE(text_in("out/log.txt").find("1 case of earlier runs (suite test)"), std::string::npos);
}

TEST_F(RunPlanTest, RefusesAFolderWithAnotherDataSetOfTheSameName) {
  CaseSpec other = spec_of(1);
  other.data_digest = "one";
  ASSERT_TRUE(run({other}, "exit 2").has_value());
  CaseSpec mine = spec_of(2);
  mine.data_digest = "two";
  const auto refused = run({mine}, "exit 2");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("paper-corridor"), std::string::npos);
  // The same case with new data takes the old one's place.
  other.data_digest = "two";
  EXPECT_TRUE(run({other}, "exit 2").has_value());
}

TEST_F(RunPlanTest, RecordsHowManyCasesRanAtATime) {
  const std::string script = "echo \"$6 $7\" >> \"$(dirname \"$0\")/calls\"; exit 2";
  num_jobs_ = 8;
  ASSERT_TRUE(run({spec_of(1)}, script).has_value());
  EXPECT_EQ(only_record().jobs, 1) << "one case has nobody beside it";
  EXPECT_EQ(text_in("calls"), "--jobs 1\n");
  ASSERT_TRUE(run({spec_of(1), spec_of(2)}, script).has_value());
  for (const results::RunResult& record : stored()) EXPECT_EQ(record.jobs, 2);
  EXPECT_EQ(text_in("calls"), "--jobs 1\n--jobs 2\n--jobs 2\n");
}

TEST_F(RunPlanTest, RecordsWhatWasSetByHandAndWhereTheDataCameFrom) {
  CaseSpec spec = spec_of(1);
  ASSERT_TRUE(run({spec}, "exit 2").has_value());
  ASSERT_TRUE(only_record().overrides.has_value());
  EXPECT_TRUE(only_record().overrides->empty());
  EXPECT_EQ(only_record().data_source, "paper-corridor");
  spec.overrides = {{"buffer_size_scans", "50"}};
  ASSERT_TRUE(run({spec}, "exit 2").has_value());
  const auto records = stored();
  EXPECT_TRUE(std::any_of(records.begin(), records.end(),
                          [&](const auto& record) { return record.overrides == spec.overrides; }));
}

TEST_F(RunPlanTest, DoesNotTakeTheRecordOfAnEarlierRunForThatOfACrash) {
  ASSERT_TRUE(run({spec_of(1)}, "exit 2").has_value());
  ASSERT_TRUE(run({spec_of(1)}, "kill -ABRT $$").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kFailed);
}

TEST_F(RunPlanTest, RemovesThePageOfAnEarlierRun) {
  folder_.write("out/index.html", "a page without this run's cases");
  ASSERT_TRUE(run({spec_of(1)}, "exit 2").has_value());
  EXPECT_FALSE(fs::exists(out() / "index.html"));
}

TEST_F(RunPlanTest, LeavesNothingButFinishedCases) {
  ASSERT_TRUE(run({spec_of(1), spec_of(2)}, "mkdir -p \"$4/runs/.half.partial\"; kill -KILL $$")
                  .has_value());
  ASSERT_TRUE(run({spec_of(1)}, "exit 2").has_value());
  EXPECT_FALSE(fs::exists(out() / ".work"));
  for (const auto& entry : fs::directory_iterator(out() / "runs")) {
    EXPECT_TRUE(fs::exists(entry.path() / "result.json")) << entry.path();
  }
}

// The script counts its calls and leaves a bad_input row.
constexpr const char* kCounting = "echo x >> \"$(dirname \"$0\")/calls\"; exit 2";

std::size_t num_calls(const testing::ScratchFolder& folder) {
  std::ifstream file(folder / "calls");
  return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(file), {}, 'x'));
}

TEST_F(RunPlanTest, ResumesOnlyWhatIsNotFinished) {
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  const auto summary = run({spec_of(1), spec_of(2)}, kCounting, true);
  EXPECT_EQ(num_calls(folder_), 2U);
  EXPECT_EQ(summary->num_kept, 1U);
  EXPECT_EQ(summary->num_cases, 2U);
  // A case kept from before that failed is a failure still.
  EXPECT_EQ(summary->num_failed, 2U);
}

TEST_F(RunPlanTest, ResumesNothingWhoseSpecChanged) {
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  CaseSpec changed = spec_of(1);
  changed.limits.time_s = 19;
  ASSERT_TRUE(run({changed}, kCounting, true).has_value());
  EXPECT_EQ(num_calls(folder_), 2U);
}

TEST_F(RunPlanTest, ResumesNothingThatAnotherBuildHasRun) {
  ASSERT_TRUE(run({spec_of(1), spec_of(2)}, kCounting).has_value());
  for (const std::optional<std::string>& build :
       {std::optional<std::string>("0123456789ab"), std::optional<std::string>()}) {
    results::RunResult record = stored().front();
    ASSERT_TRUE(record.build_id.has_value());
    record.build_id = build;
    std::ofstream(case_folder(out(), record.case_id) / "result.json") << results::to_json(record);
    const auto summary = run({spec_of(1), spec_of(2)}, kCounting, true);
    EXPECT_EQ(summary->num_kept, 1U);
    EXPECT_NE(text_in("out/log.txt")
                  .find("1 finished case is not kept: run by another build of the program"),
              std::string::npos);
  }
  EXPECT_EQ(num_calls(folder_), 4U);
}

TEST_F(RunPlanTest, RunsEverythingAgainWithoutResume) {
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  EXPECT_EQ(num_calls(folder_), 2U);
  EXPECT_EQ(stored().size(), 1U);
}

TEST(WriteFolderAtomically, ReplacesAnOlderFolderAndLeavesNothingAfterAnError) {
  const testing::ScratchFolder folder;
  const fs::path target = folder / "case";
  const auto write = [](const std::string& text) {
    return [text](const fs::path& temporary) -> Result<void> {
      std::ofstream(temporary / "file") << text;
      return {};
    };
  };
  ASSERT_TRUE(write_folder_atomically(target, write("one")).has_value());
  ASSERT_TRUE(write_folder_atomically(target, write("two")).has_value());
  const auto broken = [](const fs::path& temporary) -> Result<void> {
    std::ofstream(temporary / "file") << "three";
    return fail(ErrorCode::kInternal, "broken");
  };
  EXPECT_FALSE(write_folder_atomically(target, broken).has_value());
  std::string text;
  std::ifstream(target / "file") >> text;
  EXPECT_EQ(text, "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}), 1);
}

}  // namespace
}  // namespace corridor::runner
