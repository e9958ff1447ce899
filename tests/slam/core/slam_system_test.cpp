#include "slam/core/slam_system.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace corridor {
namespace {

class Counting final : public SlamSystem {
 public:
  int num_events = 0;

  [[nodiscard]] std::string_view name() const override { return "counting"; }
  Result<SlamEstimate> finish() override { return SlamEstimate{}; }

 private:
  Result<StepReport> on_event(const SensorEvent& event) override {
    ++num_events;
    StepReport report;
    report.stamp = stamp_of(event);
    return report;
  }
};

LaserScan scan_at(double time_s) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(time_s);
  scan.range_max_m = 10;
  scan.ranges_m = {1, 2};
  scan.is_valid = {1, 1};
  return scan;
}

void expect_refused(const SensorEvent& event, const char* word) {
  Counting system;
  const Result<StepReport> report = system.step(event);
  ASSERT_FALSE(report.has_value());
  EXPECT_EQ(report.error().code, ErrorCode::kInvalid);
  EXPECT_NE(report.error().to_line().find(word), std::string::npos) << report.error().to_line();
  EXPECT_EQ(system.num_events, 0);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SlamSystem, GetsEveryEventThatIsWhole) {
  Counting system;
  EXPECT_TRUE(system.step(WheelSample{timestamp_from_seconds(1), {}, std::nullopt}).has_value());
  EXPECT_TRUE(system.step(ImuSample{timestamp_from_seconds(1), 0, 0, 0}).has_value());
  EXPECT_TRUE(system.step(scan_at(1)).has_value());
  EXPECT_TRUE(system.step(scan_at(1.1)).has_value());
  EXPECT_EQ(system.num_events, 4);
}

TEST(SlamSystem, NeverSeesAReadingThatIsNotFinite) {
  expect_refused(ImuSample{timestamp_from_seconds(1), kNan, 0, 0}, "IMU reading is not finite");
  expect_refused(ImuSample{timestamp_from_seconds(1), 0, 0, kNan}, "IMU reading is not finite");
  LaserScan scan = scan_at(1);
  scan.ranges_m[1] = std::numeric_limits<float>::infinity();
  expect_refused(scan, "beam 1");
  scan = scan_at(1);
  scan.angle_min_rad = kNan;
  expect_refused(scan, "geometry");
}

TEST(SlamSystem, NeverSeesAScanOfUnequalOrEmptyArrays) {
  LaserScan scan = scan_at(1);
  scan.is_valid.pop_back();
  expect_refused(scan, "2 ranges and 1 validities");
  expect_refused(LaserScan{}, "0 ranges");
}

TEST(SlamSystem, NeverSeesAScanThatIsNotLaterThanTheLast) {
  Counting system;
  ASSERT_TRUE(system.step(scan_at(1)).has_value());
  const Result<StepReport> again = system.step(scan_at(1));
  ASSERT_FALSE(again.has_value());
  EXPECT_NE(again.error().to_line().find("does not increase"), std::string::npos);
  EXPECT_TRUE(system.step(scan_at(1.1)).has_value());
  EXPECT_EQ(system.num_events, 2);
}

TEST(SlamSystem, NeverSeesAnEventBeforeTheLast) {
  Counting system;
  ASSERT_TRUE(system.step(scan_at(1)).has_value());
  const Result<StepReport> early =
      system.step(WheelSample{timestamp_from_seconds(0.9), {}, std::nullopt});
  ASSERT_FALSE(early.has_value());
  EXPECT_NE(early.error().to_line().find("steps back"), std::string::npos);
  EXPECT_EQ(system.num_events, 1);
}

}  // namespace
}  // namespace corridor
