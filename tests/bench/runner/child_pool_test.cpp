#include "bench/runner/child_pool.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <iterator>
#include <map>

#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

ChildTask shell(const testing::ScratchFolder& folder, const std::string& script, int number = 0) {
  ChildTask task;
  task.command = {"/bin/sh", "-c", script};
  task.output_file = folder / ("output" + std::to_string(number));
  return task;
}

ChildResult run_one(const ChildTask& task) {
  ChildResult result;
  EXPECT_TRUE(run_children(
      {task}, 1,
      [&](std::size_t, const ChildResult& r) {
        result = r;
        return true;
      },
      [] {}));
  return result;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(ChildPool, TellsTheExitCodeAndKeepsBothOutputs) {
  const testing::ScratchFolder folder;
  const ChildTask task = shell(folder, "echo out; echo error >&2; exit 7");
  const ChildResult result = run_one(task);
  EXPECT_EQ(result.end, ChildEnd::kExited);
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_EQ(text_of(task.output_file), "out\nerror\n");
}

TEST(ChildPool, TellsACrashByItsSignal) {
  const testing::ScratchFolder folder;
  const ChildResult result = run_one(shell(folder, "kill -SEGV $$"));
  EXPECT_EQ(result.end, ChildEnd::kCrashed);
  EXPECT_EQ(result.signal, SIGSEGV);
}

TEST(ChildPool, KillsWhatTakesTooLong) {
  const testing::ScratchFolder folder;
  ChildTask task = shell(folder, "exec sleep 60");
  task.time_limit_s = 0.2;
  const ChildResult result = run_one(task);
  EXPECT_EQ(result.end, ChildEnd::kTimeout);
  EXPECT_LT(result.wall_s, 10);
}

TEST(ChildPool, KillsWhatTakesTooMuchMemory) {
  const testing::ScratchFolder folder;
  // The shell's own variable grows by doubling.
  ChildTask task = shell(folder, "x=0123456789abcdef; while :; do x=$x$x; done");
  task.memory_limit_mib = 64;
  EXPECT_EQ(run_one(task).end, ChildEnd::kOutOfMemory);
}

TEST(ChildPool, TellsThatAProgramCannotBeStarted) {
  const testing::ScratchFolder folder;
  ChildTask task = shell(folder, "");
  task.command = {"/no/such/program"};
  EXPECT_EQ(run_one(task).end, ChildEnd::kNotStarted);
}

TEST(ChildPool, FinishesEveryTaskOnceForAnyNumberOfJobs) {
  const testing::ScratchFolder folder;
  for (const int num_jobs : {1, 3, 20}) {
    std::vector<ChildTask> tasks;
    for (int i = 0; i < 7; ++i) tasks.push_back(shell(folder, "exit " + std::to_string(i), i));
    std::map<std::size_t, int> codes;
    EXPECT_TRUE(run_children(
        tasks, num_jobs,
        [&](std::size_t index, const ChildResult& r) {
          EXPECT_TRUE(codes.emplace(index, r.exit_code).second);
          return true;
        },
        [] {}));
    ASSERT_EQ(codes.size(), tasks.size());
    for (const auto& [index, code] : codes) EXPECT_EQ(code, static_cast<int>(index));
  }
}

TEST(ChildPool, StopsWhereItsCallerDoesAndLeavesNoChild) {
  const testing::ScratchFolder folder;
  // The first ends when the second has begun.
  const std::vector<ChildTask> tasks = {
      shell(folder, "while [ ! -s '" + (folder / "output1").string() + "' ]; do :; done", 0),
      shell(folder, "echo $$; exec sleep 60", 1), shell(folder, "echo third", 2)};
  int num_finished = 0;
  EXPECT_FALSE(run_children(
      tasks, 2, [&](std::size_t, const ChildResult&) { return ++num_finished < 1; }, [] {}));
  EXPECT_EQ(num_finished, 1);
  EXPECT_EQ(kill(std::stoi(text_of(tasks[1].output_file)), 0), -1) << "the child still runs";
  EXPECT_FALSE(std::filesystem::exists(tasks[2].output_file));
}

TEST(ChildPool, StopsAtAnInterruptAndLeavesNoChild) {
  const testing::ScratchFolder folder;
  std::vector<ChildTask> tasks;
  for (int i = 0; i < 3; ++i) {
    tasks.push_back(shell(folder, "echo $$; exec sleep 60", i));
  }
  int num_finished = 0;
  bool is_raised = false;
  const bool is_complete = run_children(
      tasks, 1, [&](std::size_t, const ChildResult&) { return ++num_finished > 0; },
      [&] {
        if (text_of(tasks[0].output_file).empty() || is_raised) return;
        is_raised = true;
        raise(SIGTERM);
      });
  EXPECT_FALSE(is_complete);
  EXPECT_EQ(num_finished, 0);
  const pid_t child = std::stoi(text_of(tasks[0].output_file));
  EXPECT_EQ(kill(child, 0), -1) << "the child still runs";
  EXPECT_FALSE(std::filesystem::exists(tasks[1].output_file));
}

}  // namespace
}  // namespace corridor::runner
