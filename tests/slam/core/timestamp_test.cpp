#include "slam/core/timestamp.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor {
namespace {

TEST(Timestamp, FromSecondsRoundsToTheNearestNanosecond) {
  EXPECT_EQ(timestamp_from_seconds(0).nanoseconds, 0);
  EXPECT_EQ(timestamp_from_seconds(0.1).nanoseconds, 100'000'000);
  EXPECT_EQ(timestamp_from_seconds(1.0000000014).nanoseconds, 1'000'000'001);
  EXPECT_EQ(timestamp_from_seconds(1.0000000016).nanoseconds, 1'000'000'002);
  EXPECT_EQ(timestamp_from_seconds(-0.5).nanoseconds, -500'000'000);
  EXPECT_EQ(timestamp_from_seconds(-1.25).nanoseconds, -1'250'000'000);
}

TEST(Timestamp, FromSecondsCarriesAFractionThatRoundsUpToAWholeSecond) {
  EXPECT_EQ(timestamp_from_seconds(std::nextafter(3.0, 0)).nanoseconds, 3'000'000'000);
}

TEST(Timestamp, FromSecondsKeepsWhatADoubleHoldsOfUnixTime) {
  // 1416989855.140625 is a double; multiplied by 1e9 as a double it would lose 64 ns.
  EXPECT_EQ(timestamp_from_seconds(1416989855.140625).nanoseconds, 1'416'989'855'140'625'000);
}

RC_GTEST_PROP(Timestamp, SecondsAndBackIsTheSameWithinADayOfTheEpoch, (std::uint64_t seed)) {
  // A day is 8.64e13 ns, far below 2^53.
  const Timestamp stamp{static_cast<std::int64_t>(Rng(seed).below(172'800'000'000'000)) -
                        86'400'000'000'000};
  RC_ASSERT(timestamp_from_seconds(to_seconds(stamp)) == stamp);
}

RC_GTEST_PROP(Timestamp, SecondsBetweenUndoesAddSeconds, (std::uint64_t seed)) {
  Rng rng(seed);
  const Timestamp stamp{static_cast<std::int64_t>(rng.below(1'700'000'000'000'000'000))};
  const double seconds = rng.uniform(-1000, 1000);
  RC_ASSERT(std::abs(seconds_between(stamp, add_seconds(stamp, seconds)) - seconds) <= 0.51e-9);
}

TEST(Timestamp, DifferencesOfUnixTimesAreExact) {
  const Timestamp earlier{1'416'989'855'140'000'001};
  EXPECT_EQ(seconds_between(earlier, {earlier.nanoseconds + 1}), 1e-9);
  EXPECT_EQ(seconds_between({earlier.nanoseconds + 1}, earlier), -1e-9);
}

TEST(Timestamp, IsOrderedInTime) {
  EXPECT_LT(Timestamp{1}, Timestamp{2});
  EXPECT_LT(Timestamp{-1}, Timestamp{0});
  EXPECT_EQ(Timestamp{5}, Timestamp{5});
}

}  // namespace
}  // namespace corridor
