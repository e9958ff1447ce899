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
  spec.profile = "shipped";
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
    options.out = out();
    options.executable = program;
    options.is_resumed = is_resumed;
    options.is_quiet = true;
    return run_plan({cases, {}}, options);
  }

  // The one record of the store, which must be that of result.json.
  results::RunResult only_record() {
    const auto stored =
        results::ResultsStore::open_read_only(out() / "results.sqlite")->read_all().value();
    EXPECT_EQ(stored.size(), 1U);
    const auto file = results::read_result(case_folder(out(), stored[0].case_id) / "result.json");
    EXPECT_EQ(results::to_json(file.value()), results::to_json(stored[0]));
    return stored[0];
  }

  [[nodiscard]] fs::path out() const { return folder_ / "out"; }

  testing::ScratchFolder folder_;
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

TEST_F(RunPlanTest, DoesNotTakeTheRecordOfAnEarlierRunForThatOfACrash) {
  ASSERT_TRUE(run({spec_of(1)}, "exit 2").has_value());
  ASSERT_TRUE(run({spec_of(1)}, "kill -ABRT $$").has_value());
  EXPECT_EQ(only_record().status, CaseStatus::kFailed);
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

TEST_F(RunPlanTest, RunsEverythingAgainWithoutResume) {
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  ASSERT_TRUE(run({spec_of(1)}, kCounting).has_value());
  EXPECT_EQ(num_calls(folder_), 2U);
  only_record();
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
