#include "slam/core/pose2.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "slam/core/rng.hpp"

namespace corridor {
namespace {

constexpr double kPi = std::numbers::pi;
// Products of a few poses with translations of up to 100 m: some ten roundings of 100.
constexpr double kExact = 1e-12;
// exp and log divide by angles; near pi their inverses multiply errors by about ten.
constexpr double kTight = 1e-10;
// Central differences with a step of 1e-5: step^2 times third derivatives of up to 100 m.
constexpr double kNumeric = 1e-7;
constexpr double kNumericStep = 1e-5;

Pose2 random_pose(Rng& rng) {
  return {rng.uniform(-100, 100), rng.uniform(-100, 100), rng.uniform(-kPi, kPi)};
}

// Angles of every size, from far below the switch to the series up to nearly pi.
Pose2::Tangent random_tangent(Rng& rng) {
  const double angle_rad = std::pow(10.0, rng.uniform(-9, std::log10(3.1)));
  return {rng.uniform(-10, 10), rng.uniform(-10, 10), rng.uniform() < 0.5 ? -angle_rad : angle_rad};
}

double distance(const Pose2& one, const Pose2& other) {
  return std::max((one.translation_m() - other.translation_m()).lpNorm<Eigen::Infinity>(),
                  std::abs(wrap_angle(one.theta_rad() - other.theta_rad())));
}

// Homogeneous 3x3 matrix: the second implementation of the group.
Eigen::Matrix3d matrix_of(const Pose2& pose) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() = pose.rotation();
  matrix.topRightCorner<2, 1>() = pose.translation_m();
  return matrix;
}

// Matrix exponential of the hat of tau by its power series: the second implementation of exp.
Eigen::Matrix3d exponential_series(const Pose2::Tangent& tau) {
  Eigen::Matrix3d hat;
  hat << 0, -tau.z(), tau.x(), tau.z(), 0, tau.y(), 0, 0, 0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  for (int k = 1; k < 40; ++k) {
    term = term * hat / k;
    sum += term;
  }
  return sum;
}

template <class Function>
Pose2::Matrix numeric_jacobian(const Function& function) {
  Pose2::Matrix jacobian;
  for (int column = 0; column < 3; ++column) {
    const Pose2::Tangent step = kNumericStep * Pose2::Tangent::Unit(column);
    jacobian.col(column) = (function(step) - function(-step)) / (2 * kNumericStep);
  }
  return jacobian;
}

RC_GTEST_PROP(WrapAngle, LandsInItsIntervalAndKeepsTheDirection, (std::uint64_t seed)) {
  const double angle_rad = Rng(seed).uniform(-1000, 1000);
  const double wrapped_rad = wrap_angle(angle_rad);
  RC_ASSERT(wrapped_rad > -kPi && wrapped_rad <= kPi);
  // Angles of 1000 rad are rounded by 1e-13.
  RC_ASSERT(std::abs(std::sin(wrapped_rad) - std::sin(angle_rad)) < kExact);
  RC_ASSERT(std::abs(std::cos(wrapped_rad) - std::cos(angle_rad)) < kExact);
}

TEST(WrapAngle, TakesBothHalfTurnsToPlusPi) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(0), 0);
  EXPECT_NEAR(wrap_angle(-3.5 * kPi), 0.5 * kPi, kExact);
  EXPECT_NEAR(wrap_angle(std::nextafter(-kPi, 0)), -kPi, kExact);
}

RC_GTEST_PROP(Pose2, CompositionIsAssociative, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 a = random_pose(rng), b = random_pose(rng), c = random_pose(rng);
  RC_ASSERT(distance((a * b) * c, a * (b * c)) < kExact);
}

RC_GTEST_PROP(Pose2, IdentityAndInverseAreNeutralAndOpposite, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose = random_pose(rng);
  RC_ASSERT(distance(pose * Pose2(), pose) < kExact);
  RC_ASSERT(distance(Pose2() * pose, pose) < kExact);
  RC_ASSERT(distance(pose * pose.inverse(), Pose2()) < kExact);
  RC_ASSERT(distance(pose.inverse() * pose, Pose2()) < kExact);
}

RC_GTEST_PROP(Pose2, CompositionIsTheProductOfHomogeneousMatrices, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 a = random_pose(rng), b = random_pose(rng);
  RC_ASSERT((matrix_of(a * b) - matrix_of(a) * matrix_of(b)).norm() < kExact * 10);
}

RC_GTEST_PROP(Pose2, ActsOnPointsAsItsMatrixDoes, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose = random_pose(rng);
  const Eigen::Vector2d point(rng.uniform(-10, 10), rng.uniform(-10, 10));
  RC_ASSERT(((pose * point) - (pose.rotation() * point + pose.translation_m())).norm() < kExact);
}

RC_GTEST_PROP(Pose2, BetweenIsTheStepFromOneToTheOther, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 a = random_pose(rng), b = random_pose(rng);
  RC_ASSERT(distance(a * a.between(b), b) < kExact);
}

RC_GTEST_PROP(Pose2, AngleStaysWrapped, (std::uint64_t seed)) {
  Rng rng(seed);
  Pose2 pose = random_pose(rng);
  for (int i = 0; i < 20; ++i) {
    pose = pose * random_pose(rng);
    RC_ASSERT(pose.theta_rad() > -kPi && pose.theta_rad() <= kPi);
  }
}

RC_GTEST_PROP(Pose2, LogUndoesExp, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2::Tangent tau = random_tangent(rng);
  RC_ASSERT((Pose2::exp(tau).log() - tau).norm() < kTight);
}

RC_GTEST_PROP(Pose2, ExpUndoesLog, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose = random_pose(rng);
  RC_ASSERT(distance(Pose2::exp(pose.log()), pose) < kTight);
}

RC_GTEST_PROP(Pose2, ExpIsTheMatrixExponential, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2::Tangent tau = random_tangent(rng);
  RC_ASSERT((matrix_of(Pose2::exp(tau)) - exponential_series(tau)).norm() < kTight);
}

RC_GTEST_PROP(Pose2, MinusUndoesPlus, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose = random_pose(rng);
  const Pose2::Tangent tau = random_tangent(rng);
  RC_ASSERT((pose.plus(tau).minus(pose) - tau).norm() < kTight);
}

RC_GTEST_PROP(Pose2, AdjointMovesATangentThroughThePose, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose = random_pose(rng);
  const Pose2::Tangent tau = random_tangent(rng);
  RC_ASSERT(distance(pose.plus(tau), Pose2::exp(pose.adjoint() * tau) * pose) < kTight * 10);
}

RC_GTEST_PROP(Pose2, AdjointOfAProductIsTheProductOfAdjoints, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 a = random_pose(rng), b = random_pose(rng);
  RC_ASSERT(((a * b).adjoint() - a.adjoint() * b.adjoint()).norm() < kTight);
}

RC_GTEST_PROP(Pose2, RightJacobianIsTheNumericDerivativeOfExp, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2::Tangent tau = random_tangent(rng);
  const Pose2::Matrix numeric = numeric_jacobian(
      [&](const Pose2::Tangent& step) { return Pose2::exp(tau + step).minus(Pose2::exp(tau)); });
  RC_ASSERT((Pose2::right_jacobian(tau) - numeric).norm() < kNumeric);
}

RC_GTEST_PROP(Pose2, LeftJacobianIsTheAdjointOfTheRightOne, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2::Tangent tau = random_tangent(rng);
  // [Sola2018] eq. 75: Ad_Exp(tau) = J_l * J_r^-1.
  RC_ASSERT(
      (Pose2::exp(tau).adjoint() * Pose2::right_jacobian(tau) - Pose2::left_jacobian(tau)).norm() <
      kTight);
}

RC_GTEST_PROP(Pose2, InverseOfTheRightJacobianIsItsInverse, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2::Tangent tau = random_tangent(rng);
  const Pose2::Matrix product = Pose2::right_jacobian(tau) * Pose2::right_jacobian_inverse(tau);
  RC_ASSERT((product - Pose2::Matrix::Identity()).norm() < kTight);
}

// Just above the switch to the series the plain formulas would have lost eight digits.
TEST(Pose2, JacobianIsSmoothWhereTheSeriesTakesOver) {
  const Pose2::Tangent below(3, -2, std::nextafter(1e-4, 0));
  const Pose2::Tangent above(3, -2, 1e-4);
  EXPECT_LT((Pose2::right_jacobian(below) - Pose2::right_jacobian(above)).norm(), 1e-11);
  EXPECT_LT(distance(Pose2::exp(below), Pose2::exp(above)), 1e-14);
}

TEST(Pose2, ExpOfAQuarterTurnIsTheHandComputedArc) {
  // Path of length pi/2 on a circle of radius 1 to the left: ends at (1, 1), facing +y.
  const Pose2 end = Pose2::exp({kPi / 2, 0, kPi / 2});
  EXPECT_NEAR(end.x_m(), 1, kExact);
  EXPECT_NEAR(end.y_m(), 1, kExact);
  EXPECT_NEAR(end.theta_rad(), kPi / 2, kExact);
}

TEST(Pose2, ExpOfNoRotationIsATranslation) {
  EXPECT_EQ(Pose2::exp({1.5, -2, 0}), Pose2(1.5, -2, 0));
}

TEST(Pose2, IsFiniteOnlyWithFiniteNumbers) {
  EXPECT_TRUE(Pose2(1, 2, 3).is_finite());
  EXPECT_FALSE(Pose2(NAN, 2, 3).is_finite());
  EXPECT_FALSE(Pose2(1, INFINITY, 3).is_finite());
  EXPECT_FALSE(Pose2(1, 2, NAN).is_finite());
}

RC_GTEST_PROP(TransportCovariance, ThereAndBackIsWhatItWas, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 pose(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-kPi, kPi));
  const Pose2::Matrix factor = Pose2::Matrix::NullaryExpr([&] { return rng.normal(); });
  const Pose2::Matrix covariance = factor * factor.transpose();
  const Pose2::Matrix moved = transport_covariance(pose, covariance);
  RC_ASSERT((transport_covariance(pose.inverse(), moved) - covariance).norm() < kTight);
}

TEST(TransportCovariance, HeadingErrorBecomesPositionErrorFarFromTheOrigin) {
  // 10 m along x: a heading error of 0.1 rad about the map's origin moves the robot 1 m along y.
  const Pose2::Matrix covariance = Eigen::Vector3d(0, 0, 0.01).asDiagonal();
  const Pose2::Matrix moved = transport_covariance(Pose2(10, 0, 0), covariance);
  EXPECT_NEAR(moved(1, 1), 1, kExact);
  EXPECT_NEAR(moved(1, 2), -0.1, kExact);
  EXPECT_NEAR(moved(0, 0), 0, kExact);
}

}  // namespace
}  // namespace corridor
