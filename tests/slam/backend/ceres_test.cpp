#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <memory>
#include <utility>
#include <vector>

#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/ceres/ceres_problem.hpp"
#include "slam/backend/gauss_newton/normal_equations.hpp"
#include "tests/slam/backend/random_problems.hpp"

namespace corridor::backend {
namespace {

using graph::Key;
using graph::NewFactor;
using graph::pose_key;
using graph::Values;

// Central differences with step 1e-6 leave about 1e-8 of the largest derivative.
constexpr double kNumericStep = 1e-6;
constexpr double kNumericTolerance = 1e-6;

// Adds `step` to one entry of the variable's block.
void add_to_block(Values& values, Key key, int entry, double step) {
  const Eigen::VectorXd delta = step * Eigen::VectorXd::Unit(key.dimension(), entry);
  if (key.kind == graph::VariableKind::kPose) {
    const Pose2 pose = values.pose(key.index);
    values.set_pose(key.index,
                    {pose.x_m() + delta(0), pose.y_m() + delta(1), pose.theta_rad() + delta(2)});
  } else {
    values.retract(key, delta.data());
  }
}

Eigen::VectorXd residuals_at(CeresProblem& problem, const Values& values) {
  problem.set_blocks(values);
  std::vector<double> residuals;
  EXPECT_TRUE(problem.problem().Evaluate({}, nullptr, &residuals, nullptr, nullptr));
  return Eigen::VectorXd::Map(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
}

Eigen::MatrixXd jacobian_at(CeresProblem& problem, const Values& values) {
  problem.set_blocks(values);
  ceres::CRSMatrix sparse;
  EXPECT_TRUE(problem.problem().Evaluate({}, nullptr, nullptr, nullptr, &sparse));
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (auto k = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row)]);
         k < static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row) + 1]); ++k) {
      dense(row, sparse.cols[k]) = sparse.values[k];
    }
  }
  return dense;
}

RC_GTEST_PROP(CeresProblem, JacobiansByTheBlocksEqualNumericOnesForEveryTypeOfFactor,
              (std::uint64_t seed)) {
  const testing::RandomProblem random = testing::random_drive(seed);
  graph::FactorGraph graph;
  CeresProblem problem(graph);
  for (const Key key : random.initial.keys()) problem.add_variable(key);
  for (const NewFactor& factor : random.factors) problem.add_factor(graph.add(factor));
  const Eigen::MatrixXd analytic = jacobian_at(problem, random.initial);
  int column = 0;
  for (const Key key : problem.variables().keys()) {
    for (int entry = 0; entry < key.dimension(); ++entry, ++column) {
      Values plus = random.initial, minus = random.initial;
      add_to_block(plus, key, entry, kNumericStep);
      add_to_block(minus, key, entry, -kNumericStep);
      const Eigen::VectorXd numeric =
          (residuals_at(problem, plus) - residuals_at(problem, minus)) / (2 * kNumericStep);
      RC_ASSERT((analytic.col(column) - numeric).cwiseAbs().maxCoeff() <=
                kNumericTolerance * (1 + analytic.cwiseAbs().maxCoeff()));
    }
  }
  RC_ASSERT(column == analytic.cols());
}

TEST(Ceres, MarginalCovariancesAreBlocksOfTheDenseInverse) {
  const testing::RandomProblem random = testing::random_drive(4, {graph::KernelKind::kHuber, 1});
  const auto solver = make_ceres({});
  (void)solver->add(random.factors, random.initial);
  solver->solve();
  NormalEquations equations;
  for (const Key key : random.initial.keys()) equations.add_variable(key);
  for (graph::FactorId id = 0; id < solver->graph().end_id(); ++id) {
    equations.add_factor(id, solver->graph());
  }
  equations.linearize(solver->graph(), solver->estimate());
  const Eigen::MatrixXd inverse =
      Eigen::MatrixXd(
          Eigen::MatrixXd(equations.hessian().scalars()).selfadjointView<Eigen::Lower>())
          .inverse();
  for (const Key key : {pose_key(0), pose_key(7), graph::velocity_key(7), graph::bias_key(14),
                        graph::wheel_calibration_key(0)}) {
    const auto covariance = solver->marginal_covariance(key);
    ASSERT_TRUE(covariance.has_value()) << covariance.error().to_line();
    const int row = equations.first_row(key);
    const Eigen::MatrixXd expected = inverse.block(row, row, key.dimension(), key.dimension());
    // The information's condition is some 1e8.
    EXPECT_LT((*covariance - expected).norm(), 1e-7 * expected.norm()) << graph::to_text(key);
  }
}

NewFactor edge(std::uint32_t i, std::uint32_t j, const Pose2& T_i_j) {
  return graph::RelativePose(pose_key(i), pose_key(j), T_i_j, Eigen::Matrix3d::Identity());
}

NewFactor prior(std::uint32_t i, const Eigen::Vector3d& weights) {
  return graph::PosePrior(pose_key(i), {}, weights.asDiagonal().toDenseMatrix());
}

Values poses(const std::vector<Pose2>& given) {
  Values values;
  for (std::uint32_t i = 0; i < given.size(); ++i) values.set_pose(i, given[i]);
  return values;
}

TEST(Ceres, ARemovedFactorNoLongerPulls) {
  const auto solver = make_ceres(tuned_ceres_params());
  const BackEndReport report =
      solver->update({prior(0, {1e3, 1e3, 1e3}), edge(0, 1, {1, 0, 0}), edge(0, 1, {3, 0, 0})},
                     poses({{}, {1, 0, 0}}), {});
  ASSERT_EQ(report.new_factor_ids.size(), 3u);
  solver->solve();
  EXPECT_NEAR(solver->estimate().pose(1).x_m(), 2, 1e-6);
  (void)solver->update({}, {}, std::vector{report.new_factor_ids[1]});
  EXPECT_EQ(solver->solve().num_factors, 2);
  EXPECT_NEAR(solver->estimate().pose(1).x_m(), 3, 1e-6);
}

TEST(Ceres, ReportsTheCostWithoutItsHalf) {
  const auto solver = make_ceres({});
  const BackEndReport report =
      solver->update({prior(0, {1, 1, 1}), edge(0, 1, {1, 0, 0}), edge(0, 1, {3, 0, 0})},
                     poses({{}, {1, 0, 0}}), {});
  EXPECT_NEAR(report.chi2_initial, 4, 1e-12);
  EXPECT_NEAR(report.chi2, 2, 1e-6);
}

TEST(Ceres, APartWithoutPriorIsNamedAndStaysAsItWas) {
  const auto solver = make_ceres({});
  const BackEndReport report =
      solver->update({prior(0, {1, 1, 1}), edge(0, 1, {1, 0, 0}), edge(2, 3, {1, 0, 0})},
                     poses({{}, {2, 0, 0}, {}, {2, 0, 0}}), {});
  EXPECT_EQ(report.status, SolveStatus::kRankDeficient);
  EXPECT_EQ(report.undetermined, pose_key(2));
  EXPECT_EQ(solver->estimate().pose(1), Pose2(2, 0, 0));
  EXPECT_FALSE(solver->marginal_covariance(pose_key(0)).has_value());
}

TEST(Ceres, AVariableOfNoFactorIsNamed) {
  const auto solver = make_ceres({});
  Values values = poses({{}});
  values.set_wheel_calibration(0, motion::WheelCalibration::Zero());
  EXPECT_EQ(solver->update({prior(0, {1, 1, 1})}, values, {}).undetermined,
            graph::wheel_calibration_key(0));
}

TEST(Ceres, WhatOnlyTheNumbersLeaveOpenTheCovarianceRefusesWithoutAWord) {
  for (const CeresParams& params : {CeresParams(), tuned_ceres_params()}) {
    const auto solver = make_ceres(params);
    ::testing::internal::CaptureStderr();
    const BackEndReport report =
        solver->update({prior(0, {1, 1, 0}), edge(0, 1, {1, 0, 0})}, poses({{}, {2, 0, 0}}), {});
    EXPECT_NE(report.status, SolveStatus::kNotFinite);
    EXPECT_FALSE(solver->marginal_covariance(pose_key(1)).has_value());
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

TEST(Ceres, AResidualThatIsNotFiniteIsAStatusAndChangesNothing) {
  const auto solver = make_ceres({});
  Values values;
  values.set_velocity(0, {1e10, 0});
  ::testing::internal::CaptureStderr();
  const BackEndReport report = solver->update(
      {graph::VelocityPrior(0, Eigen::Vector2d::Zero(), Eigen::Vector2d(1e-300, 1))}, values, {});
  EXPECT_EQ(report.status, SolveStatus::kNotFinite);
  EXPECT_EQ(solver->estimate().velocity(0).x(), 1e10);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Ceres, AGraphThatFitsExactlyConvergesWithEitherSettings) {
  for (const CeresParams& params : {CeresParams(), tuned_ceres_params()}) {
    const auto solver = make_ceres(params);
    graph::Values values;
    values.set_pose(0, {});
    values.set_pose(1, {1.2, 0.1, 0.1});
    values.set_pose(2, {1.1, 0.9, 1.7});
    const Eigen::Matrix3d weight = 10 * Eigen::Matrix3d::Identity();
    const Pose2 quarter(1, 0, 1.5);
    const graph::Key a = graph::pose_key(0), b = graph::pose_key(1), c = graph::pose_key(2);
    solver->add({graph::PosePrior(a, {}, weight), graph::RelativePose(a, b, quarter, weight),
                 graph::RelativePose(b, c, quarter, weight),
                 graph::RelativePose(a, c, quarter * quarter, weight)},
                values);
    const BackEndReport report = solver->solve();
    EXPECT_EQ(report.status, SolveStatus::kConverged);
    EXPECT_LT(report.chi2, 1e-9);
  }
}

TEST(Ceres, NothingToSolveIsAStatus) {
  EXPECT_EQ(make_ceres({})->solve().status, SolveStatus::kEmpty);
}

TEST(Ceres, AnUnknownSparseLibraryIsRefusedByTheParameters) {
  EXPECT_TRUE(param_violations(CeresParams()).empty());
  EXPECT_TRUE(param_violations(tuned_ceres_params()).empty());
  const auto refused = with_overrides(CeresParams(), {{"sparse_library", "magic"}}, "");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("CX_SPARSE"), std::string::npos);
}

}  // namespace
}  // namespace corridor::backend
