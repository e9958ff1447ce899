#include "slam/fusion/majority_vote.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor::fusion {
namespace {

constexpr double kGate = 9;
constexpr double kExact = 1e-9;

// Floors of 1, so that units and metres are the same.
matching::ObservabilityParams unit_floors() {
  matching::ObservabilityParams floors;
  floors.translation_floor_m = 1;
  floors.rotation_floor_rad = 1;
  return floors;
}

// A match at (x, 0, 0) that sees x with a standard deviation of 2, y of 1 and the turn of 0.5.
matching::ObservableMatch match_at(double x_m) {
  matching::ObservableMatch match;
  match.T_map_base = Pose2(x_m, 0, 0);
  match.information = Eigen::Vector3d(0.25, 1, 4).asDiagonal();
  match.num_observable = 3;
  return match;
}

// At the origin with a standard deviation of sigma_m along x, 1 along the rest.
Witness witness(double sigma_m) {
  return {Pose2(), Eigen::Vector3d(sigma_m * sigma_m, 1, 1).asDiagonal()};
}

TEST(MajorityVote, ADirectionThatBothContradictIsLeftOutAndTheOthersStay) {
  // Innovation 10, variance 2^2 + 1^2: chi-square 20 against either.
  const matching::ObservableMatch kept =
      without_outvoted(match_at(10), witness(1), witness(1), kGate, unit_floors());
  EXPECT_EQ(kept.num_observable, 2);
  EXPECT_NEAR(kept.information(0, 0), 0, kExact);
  EXPECT_NEAR(kept.information(1, 1), 1, kExact);
  EXPECT_NEAR(kept.information(2, 2), 4, kExact);
}

TEST(MajorityVote, OneWitnessAloneDoesNotOutvoteTheScan) {
  // Against a witness at the scan's own place 0, against one of sigma 10: 100 / 104.
  const Witness agreeing{Pose2(10, 0, 0), witness(1).covariance};
  for (const Witness& other : {agreeing, witness(10)}) {
    EXPECT_EQ(
        without_outvoted(match_at(10), witness(1), other, kGate, unit_floors()).num_observable, 3);
    EXPECT_EQ(
        without_outvoted(match_at(10), other, witness(1), kGate, unit_floors()).num_observable, 3);
  }
}

TEST(MajorityVote, TheGateIsOnTheInnovationOverItsVariance) {
  // sqrt(9 * 5) = 6.708.
  EXPECT_EQ(
      without_outvoted(match_at(6.70), witness(1), witness(1), kGate, unit_floors()).num_observable,
      3);
  EXPECT_EQ(
      without_outvoted(match_at(6.72), witness(1), witness(1), kGate, unit_floors()).num_observable,
      2);
}

TEST(MajorityVote, AnObliqueDirectionIsTakenOutAlone) {
  const double c = std::sqrt(0.5);
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  turned.topLeftCorner<2, 2>() << c, -c, c, c;
  matching::ObservableMatch match = match_at(0);
  match.T_map_base = Pose2(10 * c, 10 * c, 0);  // 10 along the direction of information 0.25
  match.information = turned * match.information * turned.transpose();
  const matching::ObservableMatch kept =
      without_outvoted(match, witness(1), witness(1), kGate, unit_floors());
  EXPECT_EQ(kept.num_observable, 2);
  const Eigen::Vector3d outvoted(c, c, 0);
  EXPECT_NEAR((kept.information * outvoted).norm(), 0, kExact);
  EXPECT_NEAR(kept.information.trace(), 5, kExact);
}

TEST(MajorityVote, AScanThatIsOutvotedAltogetherSaysNothing) {
  matching::ObservableMatch match = match_at(0);
  match.T_map_base = Pose2(100, 100, 3);
  match.information *= 100;
  const Witness sure{Pose2(), Eigen::Matrix3d::Identity() * 1e-4};
  const matching::ObservableMatch kept = without_outvoted(match, sure, sure, kGate, unit_floors());
  EXPECT_EQ(kept.num_observable, 0);
  EXPECT_TRUE(kept.information.isZero(0));
}

TEST(MajorityVote, WhatTheScanDoesNotSeeIsNotPutToTheVote) {
  matching::ObservableMatch blind = match_at(10);
  blind.information(0, 0) = 0;
  blind.num_observable = 2;
  const matching::ObservableMatch kept =
      without_outvoted(blind, witness(1), witness(1), kGate, unit_floors());
  EXPECT_EQ(kept.num_observable, 2);
  EXPECT_TRUE(kept.information.isApprox(blind.information, kExact));
}

}  // namespace
}  // namespace corridor::fusion
