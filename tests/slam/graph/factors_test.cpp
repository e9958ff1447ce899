#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <set>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/graph/any_factor.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace corridor::graph {
namespace {

// Central differences with step 1e-6 on residuals of size 1e2 leave about 1e-8 relative error.
constexpr double kNumericTolerance = 1e-5;

Pose2 random_pose(Rng& rng) {
  return {rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-3.1, 3.1)};
}

Eigen::Matrix3d random_information(Rng& rng) {
  Eigen::Matrix3d a;
  for (int i = 0; i < 9; ++i) a(i) = rng.normal();
  return a * a.transpose() + 0.1 * Eigen::Matrix3d::Identity();
}

motion::ImuDelta random_delta(Rng& rng) {
  motion::ImuPreintegrator integrator(ImuModel{}, motion::ImuBias(0.01, 0.02, -0.03, 0.02));
  for (int i = 0; i < 50; ++i) {
    integrator.integrate({{}, rng.normal(0.2, 0.5), rng.normal(0, 1), rng.normal(0, 1)}, 0.01);
  }
  return integrator.delta();
}

template <int kSize>
FixedVector<kSize> random_vector(Rng& rng) {
  FixedVector<kSize> v;
  for (double& entry : v) entry = rng.normal();
  return v;
}

motion::WheelDelta random_wheel_delta(Rng& rng) {
  motion::WheelDelta delta(0.1 * random_vector<7>(rng));
  for (int i = 0; i < 5; ++i) delta.append(Pose2(rng.normal(0, 0.3), 0, rng.normal(0, 0.3)));
  delta.set_twists(random_vector<3>(rng), random_vector<3>(rng));
  return delta;
}

// Two key frames with everything they may carry.
Values random_values(Rng& rng) {
  Values values;
  for (std::uint32_t i = 0; i < 2; ++i) {
    values.set_pose(i, random_pose(rng));
    values.set_velocity(i, {rng.normal(), rng.normal()});
    values.set_bias(i, 0.1 * random_vector<4>(rng));
    values.set_wheel_calibration(i, 0.1 * random_vector<7>(rng));
  }
  return values;
}

GaussianPrior random_gaussian_prior(Rng& rng) {
  Eigen::MatrixXd U(4, 12);
  for (double& entry : U.reshaped()) entry = rng.normal();
  Eigen::VectorXd offset(4);
  for (double& entry : offset) entry = rng.normal();
  return {{pose_key(0), velocity_key(1), wheel_calibration_key(0)}, random_values(rng), U, offset};
}

std::vector<AnyFactor> one_of_each(Rng& rng) {
  const Eigen::Matrix3d root = square_root_information(random_information(rng));
  const auto relative = [&](RelativePoseError error) {
    return RelativePose(pose_key(0), pose_key(1), random_pose(rng), root, error);
  };
  return {PosePrior(pose_key(0), random_pose(rng), root),
          relative(RelativePoseError::kLogarithm),
          relative(RelativePoseError::kComponents),
          WheelMotion(pose_key(0), pose_key(1), wheel_calibration_key(0), random_wheel_delta(rng),
                      root),
          ImuMotion(0, 1, random_delta(rng)),
          BiasWalk(0, 1, {0.1, 0.2, 0.3, 0.4}),
          WheelCalibrationWalk(0, 1, FixedVector<7>::Constant(0.3)),
          VelocityPrior(0, Eigen::Vector2d(1, 2), Eigen::Vector2d(0.5, 0.25)),
          BiasPrior(1, {0, 1, 2, 3}, {0.5, 0.25, 1, 2}),
          WheelCalibrationPrior(0, random_vector<7>(rng), FixedVector<7>::Constant(0.02)),
          random_gaussian_prior(rng)};
}

TEST(Factors, EveryTypeIsAmongThoseTested) {
  Rng rng(1);
  std::set<std::size_t> types;
  for (const AnyFactor& factor : one_of_each(rng)) types.insert(factor.index());
  EXPECT_EQ(types.size(), std::variant_size_v<AnyFactor>);
}

// Near a cut of the angle the residual jumps and no difference can be taken.
template <class F>
bool is_far_from_cut(const F& factor, const Values& values) {
  const Jacobian<F> numeric = testing::numeric_jacobian(factor, values);
  return numeric.allFinite() && numeric.cwiseAbs().maxCoeff() < 1e5;
}

RC_GTEST_PROP(Factors, AnalyticJacobianEqualsNumericForEveryType, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::vector<AnyFactor> factors = one_of_each(rng);
  const Values values = random_values(rng);
  for (const AnyFactor& any : factors) {
    std::visit(
        [&]<class F>(const F& factor) {
          if (!is_far_from_cut(factor, values)) return;
          Residual<F> residual;
          Jacobian<F> analytic;
          factor.linearize(values, residual, analytic);
          const Jacobian<F> numeric = testing::numeric_jacobian(factor, values);
          const double scale = 1 + numeric.cwiseAbs().maxCoeff();
          if ((analytic - numeric).cwiseAbs().maxCoeff() > kNumericTolerance * scale) {
            RC_FAIL(std::string(F::kName));
          }
        },
        any);
  }
}

RC_GTEST_PROP(Factors, LinearizeAndResidualAgree, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::vector<AnyFactor> factors = one_of_each(rng);
  const Values values = random_values(rng);
  for (const AnyFactor& any : factors) {
    std::visit(
        [&]<class F>(const F& factor) {
          Residual<F> linearized, alone;
          Jacobian<F> jacobian;
          factor.linearize(values, linearized, jacobian);
          factor.residual(values, alone);
          RC_ASSERT((linearized - alone).norm() <= 1e-12 * (1 + alone.norm()));
        },
        any);
  }
}

RC_GTEST_PROP(RelativePose, Chi2DoesNotDependOnTheMapFrame, (std::uint64_t seed)) {
  Rng rng(seed);
  const Eigen::Matrix3d root = square_root_information(random_information(rng));
  const RelativePose factor(pose_key(0), pose_key(1), random_pose(rng), root);
  const Values values = random_values(rng);
  const Pose2 gauge = random_pose(rng);
  Values moved;
  for (std::uint32_t i = 0; i < 2; ++i) moved.set_pose(i, gauge * values.pose(i));
  RC_ASSERT(std::abs(chi2_of(factor, values) - chi2_of(factor, moved)) <=
            1e-7 * (1 + chi2_of(factor, values)));
}

RC_GTEST_PROP(SquareRootInformation, SquaresToTheInformation, (std::uint64_t seed)) {
  Rng rng(seed);
  const Eigen::Matrix3d information = random_information(rng);
  const Eigen::Matrix3d root = square_root_information(information);
  RC_ASSERT((root.transpose() * root - information).norm() <= 1e-10 * information.norm());
}

RC_GTEST_PROP(GaussianPrior, IsTheQuadraticFormThatItIsMadeFrom, (std::uint64_t seed)) {
  Rng rng(seed);
  Eigen::MatrixXd half(8, 8);
  for (double& entry : half.reshaped()) entry = rng.normal();
  half.row(7) = half.row(6);  // rank 7
  const Eigen::MatrixXd H = half.transpose() * half;
  Eigen::VectorXd g = H * Eigen::VectorXd::LinSpaced(8, -1, 1);
  const Values origin = random_values(rng);
  const GaussianPrior factor =
      GaussianPrior::from_information({bias_key(0), bias_key(1)}, origin, H, g);
  const auto chi2_at = [&](const Eigen::VectorXd& delta) {
    Values moved = origin;
    moved.retract(bias_key(0), delta.data());
    moved.retract(bias_key(1), delta.data() + 4);
    return chi2_of(factor, moved);
  };
  const Eigen::VectorXd delta = Eigen::VectorXd::LinSpaced(8, 2, 0.5);
  const double expected = delta.dot(H * delta) + 2 * g.dot(delta);
  RC_ASSERT(std::abs(chi2_at(delta) - chi2_at(Eigen::VectorXd::Zero(8)) - expected) <
            1e-8 * (1 + std::abs(expected)));
}

TEST(SquareRootInformation, LeavesAnUnseenDirectionOut) {
  const Eigen::Vector3d seen(0, 1, 0);
  const Eigen::Matrix3d root = square_root_information(4 * seen * seen.transpose());
  EXPECT_NEAR((root * Eigen::Vector3d::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((root * Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((root * seen).squaredNorm(), 4, 1e-12);
}

TEST(RelativePose, IsZeroAtTheMeasurement) {
  Values values;
  values.set_pose(0, {1, 2, 0.5});
  values.set_pose(1, Pose2(1, 2, 0.5) * Pose2(0.3, -0.1, 0.2));
  const RelativePose factor(pose_key(0), pose_key(1), {0.3, -0.1, 0.2},
                            Eigen::Matrix3d::Identity());
  EXPECT_NEAR(chi2_of(factor, values), 0, 1e-24);
}

TEST(RelativePose, ComponentErrorIsG2osByHand) {
  Values values;
  values.set_pose(0, {0, 0, 0});
  values.set_pose(1, {2, 1, 0.5});
  // z = (1, 0, pi/2): e_t = R_z^T ((2, 1) - (1, 0)) = (1, -1), e_theta = 0.5 - pi/2.
  const RelativePose factor(pose_key(0), pose_key(1), {1, 0, 1.5707963267948966},
                            Eigen::Matrix3d::Identity(), RelativePoseError::kComponents);
  Eigen::Vector3d residual;
  factor.residual(values, residual);
  EXPECT_NEAR(residual(0), 1, 1e-12);
  EXPECT_NEAR(residual(1), -1, 1e-12);
  EXPECT_NEAR(residual(2), 0.5 - 1.5707963267948966, 1e-12);
}

TEST(WheelMotion, ScaleStretchesTheWheelsPath) {
  Values values;
  values.set_pose(0, {});
  values.set_pose(1, {1.02, 0, 0});
  motion::WheelCalibration calibration = motion::WheelCalibration::Zero();
  calibration(motion::kScale) = 0.02;
  values.set_wheel_calibration(0, calibration);
  motion::WheelDelta delta;
  delta.append(Pose2(1, 0, 0));
  const WheelMotion factor(pose_key(0), pose_key(1), wheel_calibration_key(0), delta,
                           Eigen::Matrix3d::Identity());
  EXPECT_NEAR(chi2_of(factor, values), 0, 1e-24);
}

// A base that turns on the spot moves an axle that lies before it.
TEST(WheelMotion, AnAxleBesideTheBaseMovesAlongACircle) {
  Values values;
  values.set_pose(0, {});
  values.set_pose(1, {0, 0, 0.5});
  motion::WheelCalibration calibration = motion::WheelCalibration::Zero();
  calibration(motion::kAxleX) = 0.2;
  values.set_wheel_calibration(0, calibration);
  motion::WheelDelta delta;
  delta.append(Pose2(0.2 * std::cos(0.5) - 0.2, 0.2 * std::sin(0.5), 0.5));
  const WheelMotion factor(pose_key(0), pose_key(1), wheel_calibration_key(0), delta,
                           Eigen::Matrix3d::Identity());
  EXPECT_NEAR(chi2_of(factor, values), 0, 1e-24);
}

TEST(ImuMotion, OneReadingOfAnIdealSensorIsAValidMeasurement) {
  ImuModel ideal;
  ideal.gyro_noise_radps = ideal.accel_noise_mps2 = 0;
  motion::ImuPreintegrator integrator(ideal, motion::ImuBias::Zero());
  integrator.integrate({{}, 0.1, 0.2, 0.3}, 0.1);
  const ImuMotion factor(0, 1, integrator.delta());
  Rng rng(1);
  EXPECT_TRUE(std::isfinite(chi2_of(factor, random_values(rng))));
}

}  // namespace
}  // namespace corridor::graph
