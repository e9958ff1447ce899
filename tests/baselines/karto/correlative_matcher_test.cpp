#include "baselines/karto/correlative_matcher.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "tests/support/synthetic_scan.hpp"

namespace corridor::karto {
namespace {

constexpr GridSpec kSequential{0.01, 0.3, 12, 0.03};
constexpr GridSpec kLoop{0.05, 8.0, 12, 0.03};
constexpr double kCoarseStep_m = 0.02;
constexpr double kHalfCoarseStep_rad = 0.01745;

LaserScan room_scan(const Pose2& T_map_base, double range_m = 12) {
  Rng rng(1);
  return testing::scan_of(testing::room(), T_map_base, range_m, 0.0, rng);
}

struct Matching {
  MatchResult result;
  Pose2 truth;
};

// A map of one scan at the origin; the second scan was really taken at `truth`, predicted at
// `guess`.
Matching match(const GridSpec& spec, const KartoParams& params, const Pose2& truth,
               const Pose2& guess, const MatchOptions& options) {
  const KeyScan map(room_scan(Pose2()), Pose2(), {});
  const KeyScan scan(room_scan(truth), Pose2(), {});
  CorrelativeMatcher matcher(spec, params);
  const std::vector<const KeyScan*> local_map = {&map};
  return {matcher.match(scan, guess, local_map, options), truth};
}

void expect_found(const Matching& matching, double tolerance_m, double tolerance_rad) {
  const Pose2::Tangent error = matching.result.T_map_sensor.minus(matching.truth);
  EXPECT_LT(error.head<2>().norm(), tolerance_m);
  EXPECT_LT(std::abs(error.z()), tolerance_rad);
}

// Truth lies between the lattice's poses, and end points of map and scan are not the same points:
// one coarse step in position, half of one in heading.
RC_GTEST_PROP(CorrelativeMatcher, FindsAKnownDisplacementWithinItsWindow, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 truth(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3));
  const Pose2 guess(truth.x_m() + rng.uniform(-0.12, 0.12), truth.y_m() + rng.uniform(-0.12, 0.12),
                    truth.theta_rad() + rng.uniform(-0.3, 0.3));
  const Matching matching =
      match(kSequential, {}, truth, guess, {.use_penalty = false, .use_refinement = true});
  const Pose2::Tangent error = matching.result.T_map_sensor.minus(truth);
  RC_ASSERT(error.head<2>().norm() < kCoarseStep_m * std::numbers::sqrt2);
  RC_ASSERT(std::abs(error.z()) < kHalfCoarseStep_rad);
  // The map's end points lie up to 7 cm apart, more than the smear of the grid fills.
  RC_ASSERT(matching.result.response > 0.6);
  RC_ASSERT(matching.result.covariance_map.diagonal().minCoeff() > 0);
}

TEST(CorrelativeMatcher, TheLoopMatcherFindsADisplacementOfMetres) {
  const Matching matching =
      match(kLoop, {}, {0.4, -0.3, 0.1}, {2.4, -2.1, 0.35}, {.use_refinement = false});
  // Steps of 0.1 m and 2 deg.
  expect_found(matching, 0.1, 0.035);
}

// 4.5 m of range in the room: its far parts give no return, with the given raw range.
double response_to_itself(const KartoParams& params, float no_return_m) {
  LaserScan scan = room_scan({}, 4.5);
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) scan.ranges_m[i] = no_return_m;
  }
  const KeyScan key_scan(scan, Pose2(), {4.5, true, params.count_no_returns});
  const std::vector<const KeyScan*> local_map = {&key_scan};
  GridSpec spec = kSequential;
  spec.reach_m = 4.5;
  return CorrelativeMatcher(spec, params).match(key_scan, {}, local_map, {}).response;
}

TEST(CorrelativeMatcher, APerfectMatchRespondsWithTheShareOfBeamsThatReturn) {
  const LaserScan scan = room_scan({}, 4.5);
  const double share =
      static_cast<double>(std::count(scan.is_valid.begin(), scan.is_valid.end(), 1)) / 360;
  ASSERT_LT(share, 0.8);
  // The points after the map's last anchor are missing, so that a few beams find nothing.
  EXPECT_NEAR(response_to_itself({}, 81), share, 0.02);
}

TEST(CorrelativeMatcher, NoReturnsThatLieInTheGridsCornersMatchEachOtherAsShipped) {
  EXPECT_GT(response_to_itself({}, 5.5), response_to_itself({}, 81) + 0.05);
}

TEST(CorrelativeMatcher, CorrectedNoReturnsChangeNothing) {
  EXPECT_GT(response_to_itself(corrected_params(), 81), 0.97);
  EXPECT_EQ(response_to_itself(corrected_params(), 5.5),
            response_to_itself(corrected_params(), 81));
}

TEST(CorrelativeMatcher, AResponseNeverExceedsOne) {
  EXPECT_LE(match(kSequential, {}, {}, {}, {}).result.response, 1.0);
}

TEST(CorrelativeMatcher, ThePenaltyLowersTheResponseOfADistantMatch) {
  const Pose2 truth(0.05, 0, 0);
  const Pose2 guess(-0.07, 0, 0);
  const MatchResult plain = match(kSequential, {}, truth, guess, {.use_penalty = false}).result;
  const MatchResult penalised = match(kSequential, {}, truth, guess, {.use_penalty = true}).result;
  EXPECT_LT(penalised.response, plain.response + 1e-12);
  const MatchResult coarse =
      match(kSequential, {}, truth, guess, {.use_penalty = true, .use_refinement = false}).result;
  const MatchResult coarse_plain =
      match(kSequential, {}, truth, guess, {.use_penalty = false, .use_refinement = false}).result;
  // 0.12 m away: 1 - 0.2 * 0.0144 / 0.09 = 0.968.
  EXPECT_NEAR(coarse.response / coarse_plain.response, 0.968, 0.01);
}

TEST(CorrelativeMatcher, AgainstAnEmptyMapStaysAtThePredictionWithAWideCovariance) {
  const KeyScan scan(room_scan({}), Pose2(), {});
  CorrelativeMatcher matcher(kSequential, {});
  const Pose2 predicted(3, 4, 0.5);
  const MatchResult result = matcher.match(scan, predicted, {}, {});
  EXPECT_EQ(result.response, 0);
  EXPECT_LT(result.T_map_sensor.minus(predicted).norm(), 1e-9);
  EXPECT_EQ(result.covariance_map(0, 0), 500);
  EXPECT_TRUE(result.covariance_map.allFinite());
}

TEST(CorrelativeMatcher, AScanWithoutAnyFiniteRangeDoesNoHarm) {
  LaserScan blind = room_scan({});
  std::fill(blind.ranges_m.begin(), blind.ranges_m.end(), std::numeric_limits<float>::quiet_NaN());
  const KeyScan map(room_scan({}), Pose2(), {});
  const KeyScan scan(blind, Pose2(), {});
  const std::vector<const KeyScan*> local_map = {&map};
  for (const KartoParams& params : {KartoParams{}, corrected_params()}) {
    CorrelativeMatcher matcher(kSequential, params);
    const MatchResult result = matcher.match(scan, {}, local_map, {});
    EXPECT_EQ(result.response, 0);
    EXPECT_TRUE(result.covariance_map.allFinite());
  }
}

TEST(CorrelativeMatcher, ResponseExpansionLooksWiderOnlyWhereNothingResponds) {
  // A fan of 7 deg, turned by 74 deg: no overlap within 60 deg.
  const auto fan = [](double angle_rad) {
    LaserScan scan;
    scan.angle_min_rad = angle_rad;
    scan.angle_increment_rad = 0.004;
    scan.range_max_m = 12;
    scan.ranges_m.assign(30, 5.0F);
    scan.is_valid.assign(30, 1);
    return scan;
  };
  const KeyScan map(fan(0), Pose2(), {});
  const KeyScan scan(fan(-1.3), Pose2(), {});
  const std::vector<const KeyScan*> local_map = {&map};
  KartoParams params;
  EXPECT_LT(CorrelativeMatcher(kSequential, params).match(scan, {}, local_map, {}).response, 1e-6);
  params.use_response_expansion = true;
  const MatchResult wide = CorrelativeMatcher(kSequential, params).match(scan, {}, local_map, {});
  EXPECT_GT(wide.response, 0.1);
  EXPECT_NEAR(wide.T_map_sensor.theta_rad(), 1.3, 0.02);
}

}  // namespace
}  // namespace corridor::karto
