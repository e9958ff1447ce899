#include "bench/runner/drive.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <limits>
#include <numeric>
#include <thread>

#include "bench/runner/cost.hpp"

namespace corridor::runner {
namespace {

using results::CaseStatus;

// A system that does what a test tells it to.
class Scripted final : public SlamSystem {
 public:
  std::function<Result<StepReport>(const SensorEvent&)> on_step = [](const SensorEvent& event) {
    return tracked(event, 0.0);
  };
  std::function<Result<SlamEstimate>()> on_finish = [] { return SlamEstimate{}; };

  static Result<StepReport> tracked(const SensorEvent& event, double x_m) {
    StepReport report;
    report.status = StepStatus::kTracked;
    report.stamp = stamp_of(event);
    report.T_map_base = Pose2(x_m, 0, 0);
    return report;
  }

  [[nodiscard]] std::string_view name() const override { return "scripted"; }
  Result<StepReport> on_event(const SensorEvent& event) override { return on_step(event); }
  Result<SlamEstimate> finish() override { return on_finish(); }
};

LaserScan scan_at(double time_s) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(time_s);
  scan.range_max_m = 10;
  scan.ranges_m = {1};
  scan.is_valid = {1};
  return scan;
}

WheelSample wheels_at(double time_s) {
  WheelSample wheels;
  wheels.stamp = timestamp_from_seconds(time_s);
  return wheels;
}

SensorLog short_log() {
  SensorLog log;
  log.events = {wheels_at(0.5), scan_at(1), wheels_at(1.5), scan_at(2), scan_at(3)};
  return log;
}

TEST(Drive, KeepsThePoseGivenAtEachScanAndNoOther) {
  Scripted system;
  const Drive run = drive(system, short_log());
  EXPECT_EQ(run.status, CaseStatus::kOk);
  ASSERT_EQ(run.online.size(), 3U);
  EXPECT_EQ(run.online[1].stamp, timestamp_from_seconds(2));
  EXPECT_EQ(run.scan_steps_s.size(), 3U);
}

TEST(Drive, CallsAPoseThatIsNotFiniteDivergedAndStops) {
  Scripted system;
  int num_steps = 0;
  system.on_step = [&](const SensorEvent& event) {
    ++num_steps;
    return Scripted::tracked(event, num_steps < 4 ? 0 : std::numeric_limits<double>::quiet_NaN());
  };
  const Drive run = drive(system, short_log());
  EXPECT_EQ(run.status, CaseStatus::kDiverged);
  EXPECT_EQ(run.status_message, "the pose at 2.000 s is not finite");
  EXPECT_EQ(num_steps, 4);
  EXPECT_FALSE(run.estimate.has_value());
}

TEST(Drive, CallsASystemThatIsLostAtTheLastScanDiverged) {
  Scripted system;
  system.on_step = [](const SensorEvent& event) {
    auto report = Scripted::tracked(event, 0);
    if (to_seconds(report->stamp) > 2.5) report->status = StepStatus::kLost;
    return report;
  };
  const Drive run = drive(system, short_log());
  EXPECT_EQ(run.status, CaseStatus::kDiverged);
  EXPECT_TRUE(run.estimate.has_value());
}

TEST(Drive, CallsAnErrorFailedAndSaysAtWhichEvent) {
  Scripted system;
  system.on_step = [](const SensorEvent& event) -> Result<StepReport> {
    if (to_seconds(stamp_of(event)) < 1.2) return Scripted::tracked(event, 0);
    return fail(ErrorCode::kInvalid, "wheels jumped");
  };
  Drive run = drive(system, short_log());
  EXPECT_EQ(run.status, CaseStatus::kFailed);
  EXPECT_EQ(run.status_message, "event 2 at 1.500 s: wheels jumped");
  Scripted without_map;
  without_map.on_finish = []() -> Result<SlamEstimate> {
    return fail(ErrorCode::kInternal, "no map");
  };
  run = drive(without_map, short_log());
  EXPECT_EQ(run.status, CaseStatus::kFailed);
  EXPECT_EQ(run.status_message, "finish: no map");
}

TEST(Drive, CallsAMapWithValuesThatAreNotFiniteDiverged) {
  Scripted system;
  system.on_finish = [] {
    SlamEstimate estimate;
    estimate.map = GridMap(0.05, {0, 0}, 2, 2);
    estimate.map->at(1, 1).log_odds = std::numeric_limits<float>::infinity();
    return estimate;
  };
  EXPECT_EQ(drive(system, short_log()).status, CaseStatus::kDiverged);
}

TEST(Drive, KeepsHealthFlagsOfScansThatHaveThem) {
  Scripted system;
  system.on_step = [](const SensorEvent& event) {
    auto report = Scripted::tracked(event, 0);
    if (to_seconds(report->stamp) > 1.7) report->is_degenerate = true;
    return report;
  };
  const Drive run = drive(system, short_log());
  ASSERT_EQ(run.health.size(), 2U);
  EXPECT_EQ(run.health[0].stamp, timestamp_from_seconds(2));
  EXPECT_FALSE(run.health[0].is_slip_detected.has_value());
}

TEST(Cost, CountsStepAndFinishOnlyAndItsStagesAddUp) {
  Scripted system;
  const auto nap = [] { std::this_thread::sleep_for(std::chrono::milliseconds(3)); };
  system.on_step = [&](const SensorEvent& event) {
    const auto scope = system.stage_clock().enter(Stage::kMatch);
    nap();
    return Scripted::tracked(event, 0);
  };
  system.on_finish = [&] {
    const auto scope = system.stage_clock().enter(Stage::kOptimise);
    nap();
    return SlamEstimate{};
  };
  const Drive run = drive(system, short_log());
  results::RunResult result;
  score_cost(run, system.stage_clock(), 2.5, result);
  EXPECT_GE(*result.wall_s, 6 * 0.003);
  EXPECT_LT(*result.cpu_s, *result.wall_s) << "sleeping is no work";
  EXPECT_GE(*result.step_p50_us, 3000);
  EXPECT_LE(*result.step_p50_us, *result.step_max_us);
  EXPECT_NEAR(*result.realtime_factor, 2.5 / *result.wall_s, 1e-12);
  EXPECT_GT(*result.peak_rss_mib, 1);
  double total_s = 0;
  for (const results::StageTimes& stage : result.stages) total_s += stage.total_s;
  // Rounding of the clock's ticks to double, once per step.
  EXPECT_NEAR(total_s, *result.wall_s, 1e-9);
  ASSERT_EQ(result.stages.size(), 3U);
  EXPECT_EQ(result.stages[0].name, "match");
  EXPECT_EQ(result.stages[0].count, 5);
  EXPECT_EQ(result.stages[1].name, "finish");
}

}  // namespace
}  // namespace corridor::runner
