#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/factors/motion_factors.hpp"
#include "slam/graph/factors/pose_factors.hpp"
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
  motion::ImuPreintegrator integrator(ImuModel{}, Eigen::Vector3d(0.01, 0.02, -0.03));
  for (int i = 0; i < 50; ++i) {
    integrator.integrate({{}, rng.normal(0.2, 0.5), rng.normal(0, 1), rng.normal(0, 1)}, 0.01);
  }
  return integrator.delta();
}

// Two key frames with everything they may carry.
Values random_values(Rng& rng) {
  Values values;
  for (std::uint32_t i = 0; i < 2; ++i) {
    values.set_pose(i, random_pose(rng));
    values.set_velocity(i, {rng.normal(), rng.normal()});
    values.set_bias(i, {0.1 * rng.normal(), 0.1 * rng.normal(), 0.1 * rng.normal()});
  }
  values.set_wheel_scale(0, 0.05 * rng.normal());
  return values;
}

std::vector<FactorPtr> one_of_each(Rng& rng) {
  std::vector<FactorPtr> factors;
  const Eigen::Matrix3d root = square_root_information(random_information(rng));
  factors.push_back(std::make_unique<PosePrior>(pose_key(0), random_pose(rng), root));
  for (const auto error : {RelativePoseError::kLogarithm, RelativePoseError::kComponents}) {
    factors.push_back(
        std::make_unique<RelativePose>(pose_key(0), pose_key(1), random_pose(rng), root, error));
  }
  factors.push_back(std::make_unique<WheelMotion>(pose_key(0), pose_key(1), wheel_scale_key(0),
                                                  random_pose(rng), root));
  factors.push_back(std::make_unique<ImuMotion>(0, 1, random_delta(rng)));
  factors.push_back(std::make_unique<BiasWalk>(0, 1, Eigen::Vector3d(0.1, 0.2, 0.3)));
  factors.push_back(std::make_unique<VectorPrior>(velocity_key(0), Eigen::Vector2d(1, 2),
                                                  Eigen::Vector2d(0.5, 0.25)));
  factors.push_back(std::make_unique<VectorPrior>(wheel_scale_key(0), Eigen::VectorXd::Zero(1),
                                                  Eigen::VectorXd::Constant(1, 0.02)));
  return factors;
}

// Near a cut of the angle the residual jumps and no difference can be taken.
bool is_far_from_cut(const Factor& factor, const Values& values) {
  const Eigen::MatrixXd numeric = testing::numeric_jacobian(factor, values);
  return numeric.allFinite() && numeric.cwiseAbs().maxCoeff() < 1e5;
}

RC_GTEST_PROP(Factors, AnalyticJacobianEqualsNumericForEveryType, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::vector<FactorPtr> factors = one_of_each(rng);
  const Values values = random_values(rng);
  for (const FactorPtr& factor : factors) {
    if (!is_far_from_cut(*factor, values)) continue;
    Eigen::VectorXd residual(factor->dimension());
    Eigen::MatrixXd analytic(factor->dimension(), factor->num_columns());
    factor->linearize(values, residual, analytic);
    const Eigen::MatrixXd numeric = testing::numeric_jacobian(*factor, values);
    const double scale = 1 + numeric.cwiseAbs().maxCoeff();
    if ((analytic - numeric).cwiseAbs().maxCoeff() > kNumericTolerance * scale) {
      RC_FAIL(std::string(factor->type()));
    }
  }
}

RC_GTEST_PROP(Factors, LinearizeAndResidualAgree, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::vector<FactorPtr> factors = one_of_each(rng);
  const Values values = random_values(rng);
  for (const FactorPtr& factor : factors) {
    Eigen::VectorXd linearized(factor->dimension()), alone(factor->dimension());
    Eigen::MatrixXd jacobian(factor->dimension(), factor->num_columns());
    factor->linearize(values, linearized, jacobian);
    factor->residual(values, alone);
    RC_ASSERT((linearized - alone).norm() <= 1e-12 * (1 + alone.norm()));
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
  RC_ASSERT(std::abs(factor.chi2(values) - factor.chi2(moved)) <= 1e-7 * (1 + factor.chi2(values)));
}

RC_GTEST_PROP(SquareRootInformation, SquaresToTheInformation, (std::uint64_t seed)) {
  Rng rng(seed);
  const Eigen::Matrix3d information = random_information(rng);
  const Eigen::Matrix3d root = square_root_information(information);
  RC_ASSERT((root.transpose() * root - information).norm() <= 1e-10 * information.norm());
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
  EXPECT_NEAR(factor.chi2(values), 0, 1e-24);
}

TEST(RelativePose, ComponentErrorIsG2osByHand) {
  Values values;
  values.set_pose(0, {0, 0, 0});
  values.set_pose(1, {2, 1, 0.5});
  // z = (1, 0, pi/2): e_t = R_z^T ((2, 1) - (1, 0)) = (1, -1), e_theta = 0.5 - pi/2.
  const RelativePose factor(pose_key(0), pose_key(1), {1, 0, 1.5707963267948966},
                            Eigen::Matrix3d::Identity(), RelativePoseError::kComponents);
  Eigen::VectorXd residual(3);
  factor.residual(values, residual);
  EXPECT_NEAR(residual(0), 1, 1e-12);
  EXPECT_NEAR(residual(1), -1, 1e-12);
  EXPECT_NEAR(residual(2), 0.5 - 1.5707963267948966, 1e-12);
}

TEST(WheelMotion, ScaleStretchesTheWheelsPath) {
  Values values;
  values.set_pose(0, {});
  values.set_pose(1, {1.02, 0, 0});
  values.set_wheel_scale(0, 0.02);
  const WheelMotion factor(pose_key(0), pose_key(1), wheel_scale_key(0), {1, 0, 0},
                           Eigen::Matrix3d::Identity());
  EXPECT_NEAR(factor.chi2(values), 0, 1e-24);
}

TEST(ImuMotion, OneReadingOfAnIdealSensorIsAValidMeasurement) {
  ImuModel ideal;
  ideal.gyro_noise_radps = ideal.accel_noise_mps2 = 0;
  motion::ImuPreintegrator integrator(ideal, Eigen::Vector3d::Zero());
  integrator.integrate({{}, 0.1, 0.2, 0.3}, 0.1);
  const ImuMotion factor(0, 1, integrator.delta());
  Rng rng(1);
  EXPECT_TRUE(std::isfinite(factor.chi2(random_values(rng))));
}

TEST(FactorGraph, RemovedFactorsCountNoMoreAndNumbersAreNotReused) {
  FactorGraph graph;
  const auto prior = [] {
    return std::make_unique<VectorPrior>(velocity_key(0), Eigen::Vector2d::Zero(),
                                         Eigen::Vector2d::Ones());
  };
  Values values;
  values.set_velocity(0, {3, 4});
  const FactorId first = graph.add(prior());
  const FactorId second = graph.add(prior());
  EXPECT_DOUBLE_EQ(graph.chi2(values), 50);
  graph.remove(first);
  EXPECT_DOUBLE_EQ(graph.chi2(values), 25);
  EXPECT_EQ(graph.num_factors(), 1u);
  EXPECT_FALSE(graph.contains(first));
  EXPECT_NE(graph.add(prior()), first);
  EXPECT_TRUE(graph.contains(second));
}

}  // namespace
}  // namespace corridor::graph
