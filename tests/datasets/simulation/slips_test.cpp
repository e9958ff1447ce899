#include "datasets/simulation/slips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/simulation/simulate.hpp"
#include "datasets/simulation/wheel_model.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.005;

Drive drive_with(const DriveParams& params, std::uint64_t seed) {
  return drive_along(draw_plan(make_corridor({}), params, Rng(seed)), params, kStep_s);
}

// Path of the left rim and of the robot up to each step, by ticks of a micrometre and by the poses.
struct Paths {
  std::vector<double> wheel_m{0}, robot_m{0};
};
Paths paths_of(const Drive& drive, const std::vector<SlipInterval>& slips) {
  const WheelParams params{.m_per_tick = 1e-6, .noise_ratio = 0};
  WheelEncoders encoders(params, {}, {}, Rng(1));
  Paths paths;
  for (std::size_t k = 1; k < drive.states.size(); ++k) {
    const DriveState& from = drive.states[k - 1];
    const DriveState& to = drive.states[k];
    const double middle_s = (static_cast<double>(k) - 0.5) * kStep_s;
    encoders.advance(from, to, kStep_s, event_ratio_at(slips, middle_s));
    const WheelTicks ticks = *encoders.sample({}).ticks;
    paths.wheel_m.push_back(0.5e-6 * static_cast<double>(ticks.left + ticks.right));
    paths.robot_m.push_back(paths.robot_m.back() +
                            to.T_world_base.minus(from.T_world_base).head<2>().norm());
  }
  return paths;
}

double ratio_between(const Paths& paths, double begin_s, double end_s) {
  const auto begin = static_cast<std::size_t>(std::lround(begin_s / kStep_s));
  const auto end = static_cast<std::size_t>(std::lround(end_s / kStep_s));
  return (paths.wheel_m[end] - paths.wheel_m[begin]) / (paths.robot_m[end] - paths.robot_m[begin]) -
         1;
}

TEST(Slips, ShareIsThePartOfTheDriveThatTheyFill) {
  for (const double share : {0.02, 0.1, 0.3, 0.5}) {
    const SlipParams params{.share = share, .duration_s = 0.7};
    const auto slips = drawn_slips(params, 60, Rng(1));
    double slipping_s = 0;
    for (const SlipInterval& slip : slips) slipping_s += slip.end_s - slip.begin_s;
    EXPECT_NEAR(slipping_s, 60 * share, 0.35 + 1e-9);  // half a slip
  }
}

TEST(Slips, NeverMeetEachOtherAndLieInsideTheDriveHoweverCrowded) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto slips = drawn_slips({.share = 0.5, .duration_s = 3}, 20, Rng(seed));
    double last_s = 0;
    for (const SlipInterval& slip : slips) {
      EXPECT_GE(slip.begin_s, last_s - 1e-9);
      last_s = slip.end_s;
    }
    EXPECT_LE(last_s, 20 + 1e-9);
  }
}

// Uniform over all placements: the middle of the first of two slips is the minimum of two uniforms.
TEST(Slips, AreSpreadEvenlyOverTheDrive) {
  std::vector<double> first_s, second_s;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const auto slips = drawn_slips({.num_slips = 2, .duration_s = 1}, 32, Rng(seed));
    first_s.push_back(slips[0].begin_s);
    second_s.push_back(slips[1].begin_s - 1);
  }
  // Of two uniforms on 30 s: means 10 s and 20 s, standard deviation 30 / sqrt(18).
  const double error_s = 5 * 30 / std::sqrt(18.0) / std::sqrt(2000.0);
  EXPECT_NEAR(mean(first_s), 10, error_s);
  EXPECT_NEAR(mean(second_s), 20, error_s);
}

TEST(Slips, RatioFoundFromTicksIsTheStatedOne) {
  const Drive drive = drive_with({}, 3);
  for (const double ratio : {-0.5, 0.25, 0.6}) {
    const SlipParams params{.num_slips = 4, .duration_s = 1.5, .ratio = ratio};
    const auto slips = drawn_slips(params, drive.duration_s(), Rng(9));
    const Paths paths = paths_of(drive, slips);
    for (const SlipInterval& slip : slips) {
      // Whole steps inside; micrometres of some decimetres.
      EXPECT_NEAR(ratio_between(paths, slip.begin_s + kStep_s, slip.end_s - kStep_s), ratio, 1e-4);
    }
    EXPECT_NEAR(ratio_between(paths, 0, slips[0].begin_s - kStep_s), 0, 1e-4);
  }
}

// At 0.5 m/s2 the floor gives what the wheels are driven with, but not in a turn beside it.
TEST(GripSlips, AppearOnlyWhereTheAccelerationExceedsTheLimit) {
  for (const double limit_mps2 : {0.1, 0.3, 0.5, 1.0, 2.0}) {
    const DriveParams params{.acceleration_mps2 = 0.5, .friction_limit_mps2 = limit_mps2};
    std::vector<SlipInterval> slips;
    append_friction_slips(drive_with(params, 1), slips);
    EXPECT_EQ(slips.empty(), limit_mps2 >= 1) << limit_mps2;
  }
}

TEST(GripSlips, RatioFoundFromTicksIsTheRecordedOneAndOutsideThereIsNone) {
  const DriveParams params{.acceleration_mps2 = 1.5, .friction_limit_mps2 = 0.3};
  const Drive drive = drive_with(params, 2);
  std::vector<SlipInterval> slips;
  append_friction_slips(drive, slips);
  const Paths paths = paths_of(drive, slips);
  bool has_spun = false, has_slid = false;
  double last_end_s = 0;
  for (const SlipInterval& slip : slips) {
    EXPECT_EQ(slip.cause, SlipCause::kGrip);
    EXPECT_NEAR(ratio_between(paths, slip.begin_s, slip.end_s), slip.ratio, 1e-4);
    has_spun = has_spun || slip.ratio > 0.1;
    has_slid = has_slid || slip.ratio < -0.1;
    // Between slips the rims' speed is the robot's to 1 cm/s.
    const auto begin = static_cast<std::size_t>(std::lround(last_end_s / kStep_s));
    const auto end = static_cast<std::size_t>(std::lround(slip.begin_s / kStep_s));
    EXPECT_NEAR(paths.wheel_m[end] - paths.wheel_m[begin],
                paths.robot_m[end] - paths.robot_m[begin],
                0.01 * (slip.begin_s - last_end_s) + 1e-4);
    last_end_s = slip.end_s;
  }
  EXPECT_TRUE(has_spun);  // when it sets off
  EXPECT_TRUE(has_slid);  // when it brakes for the corner
}

double total_s(const std::vector<SlipInterval>& slips, SlipCause cause) {
  double sum_s = 0;
  for (const SlipInterval& slip : slips)
    sum_s += slip.cause == cause ? slip.end_s - slip.begin_s : 0;
  return sum_s;
}

double shared_s(const std::vector<SlipInterval>& slips, const std::vector<SlipInterval>& events) {
  double sum_s = 0;
  for (const SlipInterval& slip : slips) {
    for (const SlipInterval& event : events) {
      sum_s +=
          std::max(0.0, std::min(slip.end_s, event.end_s) - std::max(slip.begin_s, event.begin_s));
    }
  }
  return sum_s;
}

TEST(GripSlips, LoseNothingToEventsButWhatOverlaps) {
  const DriveParams params{.acceleration_mps2 = 1.5, .friction_limit_mps2 = 0.3};
  double lost_s = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Drive drive = drive_with(params, seed);
    std::vector<SlipInterval> alone;
    append_friction_slips(drive, alone);
    const auto events = drawn_slips({.share = 0.2}, drive.duration_s(), Rng(seed));
    std::vector<SlipInterval> slips = events;
    append_friction_slips(drive, slips);
    for (std::size_t i = 1; i < slips.size(); ++i) {
      EXPECT_GE(slips[i].begin_s, slips[i - 1].end_s - 1e-9);
    }
    const double overlap_s = shared_s(alone, events);
    // Events begin between steps: half a step at each of their ends.
    EXPECT_NEAR(total_s(slips, SlipCause::kGrip), total_s(alone, SlipCause::kGrip) - overlap_s,
                kStep_s * static_cast<double>(events.size()));
    lost_s += overlap_s;
  }
  EXPECT_GT(lost_s, 5);  // else nothing was tried
}

// The speed's change and the centripetal acceleration, as the IMU feels them.
TEST(GripSlips, FloorNeverGivesMoreThanItsLimitForwardAndSidewaysTogether) {
  for (const double limit_mps2 : {0.1, 0.3, 1.0}) {
    const DriveParams params{.acceleration_mps2 = 1.5, .friction_limit_mps2 = limit_mps2};
    double most_sideways_mps2 = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Drive drive = drive_with(params, seed);
      ASSERT_TRUE(drive.is_complete);
      for (std::size_t k = 1; k < drive.states.size(); ++k) {
        const DriveState& to = drive.states[k];
        const double forward_mps2 = (to.speed_mps - drive.states[k - 1].speed_mps) / kStep_s;
        const double sideways_mps2 = to.speed_mps * to.yaw_rate_radps;
        EXPECT_LE(std::hypot(forward_mps2, sideways_mps2), limit_mps2 * (1 + 1e-9));
        most_sideways_mps2 = std::max(most_sideways_mps2, std::abs(sideways_mps2));
      }
    }
    EXPECT_GT(most_sideways_mps2, 0.5 * std::min(limit_mps2, 0.4));  // it does turn on the way
  }
}

TEST(GripSlips, AreWrittenIntoTheTruthOfALog) {
  Scenario scenario = shipped_scenario("paper-corridor-grip");
  const Simulated simulated = simulated_log(scenario, 1);
  EXPECT_TRUE(std::any_of(simulated.truth.slips.begin(), simulated.truth.slips.end(),
                          [](const SlipInterval& s) { return s.cause == SlipCause::kGrip; }));
  scenario.drive.friction_limit_mps2 = 0;
  EXPECT_TRUE(simulated_log(scenario, 1).truth.slips.empty());
}

}  // namespace
}  // namespace corridor::simulation::testing
