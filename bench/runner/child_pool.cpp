#include "bench/runner/child_pool.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <optional>

#include "bench/runner/process_clock.hpp"

namespace corridor::runner {
namespace {

using Clock = std::chrono::steady_clock;

constexpr long kPollInterval_ns = 20'000'000;
constexpr int kCannotExecute = 127;  // as shells have it

struct Child {
  std::size_t task_index = 0;
  pid_t process = -1;
  Clock::time_point begin;
  std::optional<ChildEnd> killed_for;
};

// Runs in the child between fork() and exec(): system calls only.
[[noreturn]] void execute(const std::vector<char*>& arguments, int output,
                          const sigset_t& signals) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigprocmask(SIG_SETMASK, &signals, nullptr);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execv(arguments.front(), arguments.data());
  _exit(kCannotExecute);
}

std::optional<Child> start(const ChildTask& task, std::size_t index, const sigset_t& signals) {
  std::vector<std::string> words = task.command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int output = open(task.output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (output < 0) return std::nullopt;
  const pid_t process = fork();
  if (process == 0) execute(arguments, output, signals);
  close(output);
  if (process < 0) return std::nullopt;
  return Child{index, process, Clock::now(), std::nullopt};
}

void enforce_limits(const ChildTask& task, Child& child) {
  if (child.killed_for) return;
  if (seconds_since(child.begin) > task.time_limit_s) {
    child.killed_for = ChildEnd::kTimeout;
  } else if (resident_mib(child.process).value_or(0) > static_cast<double>(task.memory_limit_mib)) {
    child.killed_for = ChildEnd::kOutOfMemory;
  }
  if (child.killed_for) kill(child.process, SIGKILL);
}

ChildResult result_of(const Child& child, int status) {
  ChildResult result;
  result.wall_s = seconds_since(child.begin);
  if (WIFEXITED(status)) {
    result.exit_code = WEXITSTATUS(status);
    result.end = result.exit_code == kCannotExecute ? ChildEnd::kNotStarted : ChildEnd::kExited;
  } else {
    result.signal = WTERMSIG(status);
    // A SIGKILL that is not ours is the kernel's, for memory.
    result.end = child.killed_for.value_or(result.signal == SIGKILL ? ChildEnd::kOutOfMemory
                                                                    : ChildEnd::kCrashed);
  }
  return result;
}

// SIGINT, SIGTERM and SIGCHLD are blocked while the pool runs and taken by sigtimedwait().
class BlockedSignals {
 public:
  BlockedSignals() {
    sigemptyset(&waited_);
    sigaddset(&waited_, SIGINT);
    sigaddset(&waited_, SIGTERM);
    sigaddset(&waited_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &waited_, &before_);
  }
  ~BlockedSignals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

  // Waits for a child's end or a moment. True: asked to stop.
  [[nodiscard]] bool wait() const {
    const timespec moment{0, kPollInterval_ns};
    const int signal = sigtimedwait(&waited_, nullptr, &moment);
    return signal == SIGINT || signal == SIGTERM;
  }
  [[nodiscard]] const sigset_t& before() const { return before_; }

 private:
  sigset_t waited_{};
  sigset_t before_{};
};

void kill_all(const std::vector<Child>& running) {
  for (const Child& child : running) {
    kill(child.process, SIGKILL);
    waitpid(child.process, nullptr, 0);
  }
}

}  // namespace

bool run_children(const std::vector<ChildTask>& tasks, int num_jobs,
                  const std::function<bool(std::size_t, const ChildResult&)>& finished,
                  const std::function<void()>& tick) {
  const BlockedSignals signals;
  std::vector<Child> running;
  std::size_t next = 0;
  bool is_wanted = true;
  while (is_wanted && (next < tasks.size() || !running.empty())) {
    while (is_wanted && next < tasks.size() &&
           running.size() < static_cast<std::size_t>(num_jobs)) {
      const std::optional<Child> child = start(tasks[next], next, signals.before());
      if (child)
        running.push_back(*child);
      else
        is_wanted = finished(next, ChildResult{});
      ++next;
    }
    if (signals.wait()) {
      kill_all(running);
      return false;
    }
    for (std::size_t i = 0; is_wanted && i < running.size();) {
      int status = 0;
      if (waitpid(running[i].process, &status, WNOHANG) == running[i].process) {
        const Child child = running[i];
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        is_wanted = finished(child.task_index, result_of(child, status));
      } else {
        enforce_limits(tasks[running[i].task_index], running[i]);
        ++i;
      }
    }
    tick();
  }
  kill_all(running);
  return is_wanted;
}

}  // namespace corridor::runner
