// What the user sees while a suite runs: one line per finished case, and on a terminal one more
// line with the time that is left.
#pragma once

#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>

#include "bench/results/run_result.hpp"

namespace corridor::runner {

class Progress {
 public:
  // Lines go to `log_file` (appended) always, to standard output unless quiet.
  Progress(std::size_t num_cases, bool is_quiet, bool is_terminal, const std::string& log_file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void note(const std::string& line);
  void case_done(const results::RunResult& result, double case_wall_s);
  // Redraws the status line; call it as often as you like.
  void tick();

 private:
  void erase_status() const;

  std::size_t num_cases_;
  std::size_t num_done_ = 0;
  bool is_quiet_;
  bool is_terminal_;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_drawn_;
  std::ofstream log_;
};

}  // namespace corridor::runner
