// Where the time of a step goes: exclusive wall times per stage that add up to the step.
// A stage entered inside another pauses the outer one. Not for more than one thread: a system's
// parallel loops lie inside one stage.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

namespace corridor {

// The one vocabulary of stages.
enum class Stage {
  kPreprocess,
  kPredict,
  kMatch,
  kMapUpdate,
  kGraph,
  kOptimise,
  kLoopSearch,
  kResample,
  kFinish,
  kOther,
};
inline constexpr std::size_t kNumStages = 10;
inline constexpr std::array<std::string_view, kNumStages> kStageNames = {
    "preprocess", "predict",     "match",    "map_update", "graph",
    "optimise",   "loop_search", "resample", "finish",     "other"};

class StageClock {
 public:
  // Leaves the stage when destroyed.
  class Scope {
   public:
    Scope(StageClock& clock, Stage stage) : clock_(clock), outer_(clock.switch_to(stage)) {}
    ~Scope() { clock_.switch_to(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageClock& clock_;
    Stage outer_;
  };

  [[nodiscard]] Scope enter(Stage stage) { return Scope(*this, stage); }

  // The harness calls these around step() and finish(); time outside any scope counts as `base`.
  // Inside a step of base kFinish every stage counts as kFinish: what a system does at the end is
  // not a step's work, and the samples of a stage stay below the longest step of a scan.
  void begin_step(Stage base = Stage::kOther);
  void end_step();

  // Seconds of each step in which the stage was entered, in order of the steps.
  [[nodiscard]] const std::vector<double>& samples_s(Stage stage) const {
    return samples_s_[static_cast<std::size_t>(stage)];
  }
  // Seconds of each whole step, begin to end.
  [[nodiscard]] const std::vector<double>& step_samples_s() const { return step_samples_s_; }

 private:
  using Clock = std::chrono::steady_clock;

  Stage switch_to(Stage stage);

  bool is_finishing_ = false;
  Stage current_ = Stage::kOther;
  Clock::time_point since_{};
  Clock::time_point step_begin_{};
  std::array<Clock::duration, kNumStages> step_times_{};
  std::array<bool, kNumStages> is_entered_{};
  std::array<std::vector<double>, kNumStages> samples_s_;
  std::vector<double> step_samples_s_;
};

}  // namespace corridor
