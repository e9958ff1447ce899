#include "datasets/formats/stamp_order.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace corridor::formats {
namespace {

double squared_distance(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(static_cast<double>(a[i] - b[i]), 2);
  return sum;
}

std::vector<std::int64_t> wide(const std::vector<int>& values) {
  return {values.begin(), values.end()};
}

RC_GTEST_PROP(IsotonicStamps, IncreaseByAtLeastTheStep, (std::vector<int> values)) {
  constexpr std::int64_t kStep = 3;
  const auto fitted = isotonic_stamps(wide(values), kStep);
  RC_ASSERT(fitted.size() == values.size());
  for (std::size_t i = 1; i < fitted.size(); ++i) RC_ASSERT(fitted[i] - fitted[i - 1] >= kStep);
}

RC_GTEST_PROP(IsotonicStamps, LeaveWhatFitsAlone, (std::vector<int> values)) {
  std::vector<std::int64_t> stamps;
  std::int64_t last = 0;
  for (const int value : values) stamps.push_back(last += 3 + std::abs(value % 1000));
  RC_ASSERT(isotonic_stamps(stamps, 3) == stamps);
}

RC_GTEST_PROP(IsotonicStamps, AreIdempotent, (std::vector<int> values)) {
  const auto once = isotonic_stamps(wide(values), 5);
  RC_ASSERT(isotonic_stamps(once, 5) == once);
}

RC_GTEST_PROP(IsotonicStamps, CommuteWithAShift, (std::vector<int> values, int shift)) {
  auto moved = wide(values);
  for (auto& value : moved) value += shift;
  auto expected = isotonic_stamps(wide(values), 2);
  for (auto& value : expected) value += shift;
  RC_ASSERT(isotonic_stamps(moved, 2) == expected);
}

// Least squares: no feasible point nearby is closer, up to the rounding to whole nanoseconds.
RC_GTEST_PROP(IsotonicStamps, AreTheNearestSequenceThatFits, ()) {
  const auto values = *rc::gen::container<std::vector<int>>(6, rc::gen::inRange(-50, 50));
  const auto other = *rc::gen::container<std::vector<int>>(6, rc::gen::inRange(-60, 60));
  auto feasible = wide(other);
  std::sort(feasible.begin(), feasible.end());
  for (std::size_t i = 0; i < feasible.size(); ++i) feasible[i] += static_cast<std::int64_t>(i);
  const auto stamps = wide(values);
  const double best = squared_distance(isotonic_stamps(stamps, 1), stamps);
  // Rounding moves each of 6 values by at most 1/2 from a block mean: n / 4 more squared distance.
  RC_ASSERT(best <= squared_distance(feasible, stamps) + 1.5);
}

TEST(IsotonicStamps, PoolsTheViolatorsOfAHandComputedCase) {
  // 10 20 [40 30 20] 50: the block's mean is 30; with a step of 2 minus i*2 it is 30, 32, 34.
  EXPECT_EQ(isotonic_stamps({10, 20, 40, 30, 20, 50}, 2),
            (std::vector<std::int64_t>{10, 20, 28, 30, 32, 50}));
  EXPECT_EQ(isotonic_stamps({5, 5, 5}, 1), (std::vector<std::int64_t>{4, 5, 6}));
  EXPECT_TRUE(isotonic_stamps({}, 1).empty());
}

TEST(StampOrder, AStepBackNamesTheRow) {
  ParsedLog log;
  log.origin_unit = "line";
  log.add(WheelSample{{2'000}, {}, {}}, 7);
  log.add(WheelSample{{1'000}, {}, {}}, 9);
  const auto checked = check_stamp_order(log, "a.clf");
  ASSERT_FALSE(checked.has_value());
  EXPECT_NE(checked.error().to_line().find("a.clf: line 9: stamp steps back by 0.000001 s"),
            std::string::npos);
}

TEST(StampOrder, ASensorMayNotRepeatItsStampButTwoSensorsMayShareOne) {
  ParsedLog log;
  log.origin_unit = "byte";
  log.add(WheelSample{{5}, {}, {}}, 0);
  log.add(ImuSample{{5}, 0, 0, 0}, 10);
  EXPECT_TRUE(check_stamp_order(log, "a").has_value());
  log.add(WheelSample{{5}, {}, {}}, 20);
  EXPECT_FALSE(check_stamp_order(log, "a").has_value());
}

TEST(StampOrder, RowsKeepTheirOrderAndSharedStampsStayShared) {
  std::vector<SensorEvent> events = {WheelSample{{300'000}, {}, {}}, ImuSample{{300'000}, 0, 0, 0},
                                     WheelSample{{100'000}, {}, {}}, ImuSample{{900'000}, 0, 0, 0}};
  EXPECT_EQ(make_stamps_increase(events), 2U);
  EXPECT_EQ(stamp_of(events[0]), stamp_of(events[1]));
  EXPECT_EQ(stamp_of(events[2]).nanoseconds - stamp_of(events[1]).nanoseconds, kMinStep_ns);
  EXPECT_EQ(stamp_of(events[3]).nanoseconds, 900'000);
  EXPECT_TRUE(std::holds_alternative<WheelSample>(events[2]));
}

}  // namespace
}  // namespace corridor::formats
