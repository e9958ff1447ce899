#include "slam/core/stage_clock.hpp"

namespace corridor {
namespace {

double to_s(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Stage StageClock::switch_to(Stage stage) {
  if (is_finishing_) stage = Stage::kFinish;
  const auto now = Clock::now();
  step_times_[static_cast<std::size_t>(current_)] += now - since_;
  since_ = now;
  is_entered_[static_cast<std::size_t>(stage)] = true;
  const Stage outer = current_;
  current_ = stage;
  return outer;
}

void StageClock::begin_step(Stage base) {
  step_times_.fill({});
  is_entered_.fill(false);
  is_entered_[static_cast<std::size_t>(base)] = true;
  is_finishing_ = base == Stage::kFinish;
  current_ = base;
  step_begin_ = since_ = Clock::now();
}

void StageClock::end_step() {
  const auto now = Clock::now();
  step_times_[static_cast<std::size_t>(current_)] += now - since_;
  for (std::size_t i = 0; i < kNumStages; ++i) {
    if (is_entered_[i]) samples_s_[i].push_back(to_s(step_times_[i]));
  }
  step_samples_s_.push_back(to_s(now - step_begin_));
}

}  // namespace corridor
