#include "slam/core/stage_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>

namespace corridor {
namespace {

// Sums of a few durations in whole nanoseconds, each turned into seconds once.
constexpr double kExact_s = 1e-12;

// Keeps the processor busy, so that the clock's reading is not that of a sleeping thread's
// scheduler.
void work_for(std::chrono::microseconds duration) {
  const auto end = std::chrono::steady_clock::now() + duration;
  while (std::chrono::steady_clock::now() < end) {
  }
}

double total_s(const StageClock& clock) {
  double sum = 0;
  for (std::size_t i = 0; i < kNumStages; ++i) {
    const auto& samples = clock.samples_s(static_cast<Stage>(i));
    sum = std::accumulate(samples.begin(), samples.end(), sum);
  }
  return sum;
}

TEST(StageClock, ExclusiveTimesAddUpToTheStep) {
  StageClock clock;
  for (int step = 0; step < 5; ++step) {
    clock.begin_step();
    work_for(std::chrono::microseconds(200));
    {
      const auto match = clock.enter(Stage::kMatch);
      work_for(std::chrono::microseconds(300));
      {
        const auto map = clock.enter(Stage::kMapUpdate);
        work_for(std::chrono::microseconds(400));
      }
      work_for(std::chrono::microseconds(100));
    }
    clock.end_step();
  }
  ASSERT_EQ(clock.step_samples_s().size(), 5u);
  const double steps_s =
      std::accumulate(clock.step_samples_s().begin(), clock.step_samples_s().end(), 0.0);
  EXPECT_NEAR(total_s(clock), steps_s, kExact_s);
}

TEST(StageClock, InnerStagePausesTheOuterOne) {
  StageClock clock;
  clock.begin_step();
  {
    const auto match = clock.enter(Stage::kMatch);
    const auto inner = clock.enter(Stage::kOptimise);
    work_for(std::chrono::milliseconds(5));
  }
  clock.end_step();
  ASSERT_EQ(clock.samples_s(Stage::kOptimise).size(), 1u);
  EXPECT_GE(clock.samples_s(Stage::kOptimise)[0], 0.005);
  ASSERT_EQ(clock.samples_s(Stage::kMatch).size(), 1u);
  // Only the two switches; five milliseconds would be the inner stage's time counted twice.
  EXPECT_LT(clock.samples_s(Stage::kMatch)[0], 0.0025);
}

TEST(StageClock, StageEnteredTwiceInAStepIsOneSample) {
  StageClock clock;
  clock.begin_step();
  for (int i = 0; i < 2; ++i) {
    const auto match = clock.enter(Stage::kMatch);
    work_for(std::chrono::milliseconds(1));
  }
  clock.end_step();
  ASSERT_EQ(clock.samples_s(Stage::kMatch).size(), 1u);
  EXPECT_GE(clock.samples_s(Stage::kMatch)[0], 0.002);
}

TEST(StageClock, StageNotEnteredHasNoSample) {
  StageClock clock;
  clock.begin_step();
  clock.end_step();
  clock.begin_step();
  { const auto graph = clock.enter(Stage::kGraph); }
  clock.end_step();
  EXPECT_EQ(clock.samples_s(Stage::kGraph).size(), 1u);
  EXPECT_EQ(clock.samples_s(Stage::kMatch).size(), 0u);
  EXPECT_EQ(clock.samples_s(Stage::kOther).size(), 2u);
}

TEST(StageClock, TimeOutsideAnyScopeCountsAsTheBaseOfTheStep) {
  StageClock clock;
  clock.begin_step(Stage::kFinish);
  work_for(std::chrono::milliseconds(1));
  clock.end_step();
  ASSERT_EQ(clock.samples_s(Stage::kFinish).size(), 1u);
  EXPECT_GE(clock.samples_s(Stage::kFinish)[0], 0.001);
  EXPECT_TRUE(clock.samples_s(Stage::kOther).empty());
}

TEST(StageClock, WhateverIsEnteredWhileFinishingCountsAsFinish) {
  StageClock clock;
  clock.begin_step(Stage::kFinish);
  {
    const auto optimise = clock.enter(Stage::kOptimise);
    const auto map = clock.enter(Stage::kMapUpdate);
    work_for(std::chrono::milliseconds(1));
  }
  clock.end_step();
  EXPECT_TRUE(clock.samples_s(Stage::kOptimise).empty());
  EXPECT_TRUE(clock.samples_s(Stage::kMapUpdate).empty());
  ASSERT_EQ(clock.samples_s(Stage::kFinish).size(), 1u);
  EXPECT_NEAR(clock.samples_s(Stage::kFinish)[0], clock.step_samples_s()[0], kExact_s);
  clock.begin_step();
  { const auto optimise = clock.enter(Stage::kOptimise); }
  clock.end_step();
  EXPECT_EQ(clock.samples_s(Stage::kOptimise).size(), 1u) << "the next step is a step again";
}

TEST(StageClock, TimeBetweenStepsIsNobodys) {
  StageClock clock;
  clock.begin_step();
  clock.end_step();
  work_for(std::chrono::milliseconds(5));
  clock.begin_step();
  clock.end_step();
  EXPECT_LT(clock.step_samples_s()[0] + clock.step_samples_s()[1], 0.0025);
}

TEST(StageClock, EveryStageHasItsOwnName) {
  ASSERT_EQ(static_cast<std::size_t>(Stage::kOther), kNumStages - 1);
  for (std::size_t i = 0; i < kNumStages; ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(kStageNames[i], kStageNames[j]);
  }
  EXPECT_EQ(kStageNames[static_cast<std::size_t>(Stage::kLoopSearch)], "loop_search");
}

}  // namespace
}  // namespace corridor
