#include "bench/runner/progress.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "bench/runner/printable.hpp"
#include "bench/runner/process_clock.hpp"

namespace corridor::runner {
namespace {

std::string duration_text(double seconds) {
  const int whole_s = static_cast<int>(seconds);
  if (whole_s < 60) return fmt::format("{} s", whole_s);
  if (whole_s < 3600) return fmt::format("{} min {:02d} s", whole_s / 60, whole_s % 60);
  return fmt::format("{} h {:02d} min", whole_s / 3600, whole_s / 60 % 60);
}

// The one number that says most about a case.
std::string headline(const results::RunResult& result) {
  if (result.chi2_gap_ratio) {
    return fmt::format(", chi2 {:.6g}, {:+.1e} of the best", *result.chi2, *result.chi2_gap_ratio);
  }
  if (result.final_scores.position_rmse_m) {
    return fmt::format(", position RMSE {:.3f} m", *result.final_scores.position_rmse_m);
  }
  if (result.final_relations.relations_translation_mean_m) {
    return fmt::format(", mean relation error {:.3f} m",
                       *result.final_relations.relations_translation_mean_m);
  }
  return "";
}

}  // namespace

Progress::Progress(std::size_t num_cases, bool is_quiet, bool is_terminal,
                   const std::string& log_file)
    : num_cases_(num_cases),
      is_quiet_(is_quiet),
      is_terminal_(is_terminal && !is_quiet),
      begin_(std::chrono::steady_clock::now()),
      last_drawn_(begin_),
      log_(log_file, std::ios::app) {}

Progress::~Progress() { erase_status(); }

void Progress::erase_status() const {
  if (!is_terminal_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
}

void Progress::note(const std::string& line) {
  const std::string shown = printable(line);
  log_ << shown << "\n" << std::flush;
  if (is_quiet_) return;
  erase_status();
  std::fputs((shown + "\n").c_str(), stdout);
  std::fflush(stdout);
}

void Progress::case_done(const results::RunResult& result, double case_wall_s) {
  ++num_done_;
  std::string name = fmt::format("{}{} {}@{}", result.dataset,
                                 result.data_seed ? fmt::format(" seed {}", *result.data_seed)
                                                  : fmt::format(" seed {}", result.system_seed),
                                 result.system, result.profile);
  if (result.backend) name += " " + *result.backend;
  note(fmt::format("[{}/{}] {}: {}{}, {:.1f} s{}{}", num_done_, num_cases_, name,
                   to_text(result.status), headline(result), case_wall_s,
                   result.status_message.empty() ? "" : ": ", result.status_message));
  for (const std::string& text : result.notes) note("  note: " + text);
}

void Progress::tick() {
  constexpr double kRedrawInterval_s = 0.5;
  if (!is_terminal_ || seconds_since(last_drawn_) < kRedrawInterval_s) return;
  last_drawn_ = std::chrono::steady_clock::now();
  const double elapsed_s = seconds_since(begin_);
  std::string line =
      fmt::format("{} of {} cases, {} so far", num_done_, num_cases_, duration_text(elapsed_s));
  if (num_done_ > 0) {
    const double left_s =
        elapsed_s / static_cast<double>(num_done_) * static_cast<double>(num_cases_ - num_done_);
    line += ", about " + duration_text(left_s) + " left";
  }
  erase_status();
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace corridor::runner
