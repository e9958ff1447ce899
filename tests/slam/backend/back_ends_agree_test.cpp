#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/core/rng.hpp"
#include "tests/slam/backend/random_problems.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::backend {
namespace {

using graph::KernelKind;
using graph::RobustKernel;
using testing::RandomProblem;

// Metres, radians, m/s: where a sum of squares of this size is known to 15 digits.
constexpr double kSameOptimum = 1e-6;
// Under a kernel that nearly turns factors off, the same digits of the cost hold a variable less.
constexpr double kSameOptimumOfFewFactors = 1e-4;
// Of the recorded graphs' chi2, which is known to as many digits.
constexpr double kSameChi2 = 1e-6;

struct Rival {
  std::string name;
  std::function<std::unique_ptr<BackEnd>()> make;
};

constexpr int kPlentyOfIterations = 500;

Rival least_squares(std::string name, bool use_damping, double min_relative_decrease) {
  LeastSquaresParams params;
  params.use_damping = use_damping;
  params.max_iterations = kPlentyOfIterations;
  params.min_relative_decrease = min_relative_decrease;
  return {std::move(name), [params] { return make_least_squares(params); }};
}

Rival ceres(std::string name, CeresParams params, double min_relative_decrease) {
  params.max_iterations = kPlentyOfIterations;
  params.function_tolerance = min_relative_decrease;
  params.parameter_tolerance = 1e-12;
  return {std::move(name), [params] { return make_ceres(params); }};
}

Rival isam2(double min_relative_decrease) {
  Isam2Params params;
  params.max_iterations = kPlentyOfIterations;
  params.min_relative_decrease = min_relative_decrease;
  return {"isam2", [params] { return make_isam2(params); }};
}

// The first is the judge.
std::vector<Rival> rivals(double min_relative_decrease) {
  return {least_squares("gauss-newton", false, min_relative_decrease),
          least_squares("levenberg", true, min_relative_decrease), isam2(min_relative_decrease),
          ceres("ceres", {}, min_relative_decrease),
          ceres("ceres@tuned", tuned_ceres_params(), min_relative_decrease)};
}

void expect_one_optimum(const RandomProblem& problem, double tolerance = kSameOptimum) {
  constexpr double kDownToRounding = 1e-15;
  std::unique_ptr<BackEnd> judge;
  for (const Rival& rival : rivals(kDownToRounding)) {
    auto solver = rival.make();
    (void)solver->add(problem.factors, problem.initial);
    const BackEndReport report = solver->solve();
    if (report.status != SolveStatus::kConverged) {
      RC_FAIL(rival.name + ": " + to_text(report.status));
    }
    if (judge == nullptr) {
      judge = std::move(solver);
      continue;
    }
    const double difference = testing::largest_difference(judge->estimate(), solver->estimate());
    if (difference > tolerance) RC_FAIL(rival.name + " is off by " + std::to_string(difference));
    RC_ASSERT(std::abs(report.chi2 - judge->graph().cost(judge->estimate())) <=
              kSameChi2 * (1 + report.chi2));
  }
}

// The same problem from somewhere near an optimum of it: under a kernel that is not convex there
// may be several.
RandomProblem from_near_an_optimum(RandomProblem problem, std::uint64_t seed) {
  constexpr double kNear = 1e-3;
  const auto finder = least_squares("", true, 1e-12).make();
  (void)finder->add(problem.factors, problem.initial);
  RC_ASSERT(finder->solve().status == SolveStatus::kConverged);
  problem.initial = finder->estimate();
  Rng rng(seed);
  for (const graph::Key key : problem.initial.keys()) {
    std::vector<double> step(static_cast<std::size_t>(key.dimension()));
    for (double& component : step) component = rng.normal(0, kNear);
    problem.initial.retract(key, step.data());
  }
  return problem;
}

RC_GTEST_PROP(BackEnds, GiveBackTheValuesThatWereSetAndSolveFromThem, (std::uint64_t seed)) {
  const RandomProblem problem = testing::random_walk(seed);
  for (const Rival& rival : rivals(1e-12)) {
    auto solver = rival.make();
    (void)solver->update(problem.factors, problem.initial, {});
    const graph::Values before = solver->estimate();
    graph::Values set;
    for (const std::uint32_t index : {0U, 7U, 13U}) {
      set.set_pose(index, before.pose(index).plus({0.02, -0.01, 0.03}));
    }
    solver->set_values(set);
    for (const graph::Key key : before.keys()) {
      const Pose2& expected = set.contains(key) ? set.pose(key.index) : before.pose(key.index);
      RC_ASSERT(solver->estimate().pose(key.index).minus(expected).norm() < 1e-12);
      RC_ASSERT(solver->pose(key.index).minus(expected).norm() < 1e-12);
    }
    RC_ASSERT(solver->solve().status == SolveStatus::kConverged);
    const double chi2 = solver->graph().cost(solver->estimate());
    solver->set_values(problem.initial);
    (void)solver->solve();
    RC_ASSERT(std::abs(solver->graph().cost(solver->estimate()) - chi2) <= kSameChi2 * (1 + chi2));
  }
}

RC_GTEST_PROP(BackEnds, AgreeOnRandomPoseGraphs, (std::uint64_t seed)) {
  expect_one_optimum(testing::random_walk(seed));
}

RC_GTEST_PROP(BackEnds, AgreeOnRandomInertialGraphs, (std::uint64_t seed)) {
  expect_one_optimum(testing::random_drive(seed));
}

RC_GTEST_PROP(BackEnds, AgreeUnderHubersKernel, (std::uint64_t seed)) {
  expect_one_optimum(testing::random_walk(seed, {KernelKind::kHuber, 1}));
  expect_one_optimum(testing::random_drive(seed, {KernelKind::kHuber, 1}));
}

RC_GTEST_PROP(BackEnds, AgreeUnderCauchysKernel, (std::uint64_t seed)) {
  expect_one_optimum(
      from_near_an_optimum(testing::random_walk(seed, {KernelKind::kCauchy, 3}), seed),
      kSameOptimumOfFewFactors);
  expect_one_optimum(
      from_near_an_optimum(testing::random_drive(seed, {KernelKind::kCauchy, 3}), seed),
      kSameOptimumOfFewFactors);
}

RC_GTEST_PROP(BackEnds, AgreeUnderTheKernelOfGemanAndMcClure, (std::uint64_t seed)) {
  expect_one_optimum(
      from_near_an_optimum(testing::random_walk(seed, {KernelKind::kGemanMcClure, 5}), seed),
      kSameOptimumOfFewFactors);
  expect_one_optimum(
      from_near_an_optimum(testing::random_drive(seed, {KernelKind::kGemanMcClure, 5}), seed),
      kSameOptimumOfFewFactors);
}

// A graph of the catalogue with the best chi2 known, from four independent solvers.
struct RecordedGraph {
  std::string file;
  double best_chi2;
  // Information up to 1e12: whatever refuses steps that raise chi2 gets stuck far away.
  bool defeats_damping = false;
};

void PrintTo(const RecordedGraph& graph, std::ostream* out) { *out << graph.file; }

class RecordedGraphs : public ::testing::TestWithParam<RecordedGraph> {};

graph::Values file_values(const formats::PoseGraph& graph) {
  graph::Values values;
  for (const auto& vertex : graph.vertices) values.set_pose(vertex.id, vertex.T_map_base);
  return values;
}

// Dead reckoning along the edges from each pose to the next.
graph::Values odometry_values(const formats::PoseGraph& graph) {
  graph::Values values;
  values.set_pose(graph.vertices[0].id, graph.vertices[0].T_map_base);
  for (const auto& edge : graph.edges) {
    if (edge.j == edge.i + 1 && !values.contains(graph::pose_key(edge.j))) {
      values.set_pose(edge.j, values.pose(edge.i) * edge.T_i_j);
    }
  }
  return values;
}

void expect_best_chi2(const RecordedGraph& expected, const formats::PoseGraph& recorded,
                      const graph::Values& initial) {
  const graph::FactorGraph edges = formats::factor_graph_of(recorded).factors;
  const std::uint32_t first = recorded.vertices[0].id;
  for (const Rival& rival : rivals(kSameChi2 / 1000)) {
    if (expected.defeats_damping && rival.name != "gauss-newton" && rival.name != "isam2") continue;
    std::vector<graph::NewFactor> factors;
    factors.emplace_back(
        graph::PosePrior(graph::pose_key(first), initial.pose(first), testing::pose_weight(1e-3)));
    edges.for_each([&](graph::FactorId, const auto& factor, const RobustKernel&) {
      factors.emplace_back(factor);
    });
    const auto solver = rival.make();
    (void)solver->add(std::move(factors), initial);
    (void)solver->solve();
    EXPECT_NEAR(edges.chi2(solver->estimate()), expected.best_chi2, kSameChi2 * expected.best_chi2)
        << rival.name;
  }
}

TEST_P(RecordedGraphs, AreSolvedToTheBestChi2KnownFromTheFilesPosesAndFromOdometry) {
  const std::filesystem::path relative = "graphs/" + GetParam().file;
  const auto path = testing::recorded_file(relative);
  if (!path) GTEST_SKIP() << testing::missing_data_message(relative);
  const auto recorded = formats::read_pose_graph(*path);
  ASSERT_TRUE(recorded.has_value()) << recorded.error().to_line();
  const graph::Values from_odometry = odometry_values(*recorded);
  ASSERT_EQ(from_odometry.size(), recorded->vertices.size());
  expect_best_chi2(GetParam(), *recorded, file_values(*recorded));
  expect_best_chi2(GetParam(), *recorded, from_odometry);
}

INSTANTIATE_TEST_SUITE_P(BackEnds, RecordedGraphs,
                         ::testing::Values(RecordedGraph{"M3500.g2o", 137.912951},
                                           RecordedGraph{"manhattanOlson3500.g2o", 146.076613},
                                           RecordedGraph{"CSAIL.graph", 38.956286},
                                           RecordedGraph{"FRH.graph", 1.93136811e-4},
                                           RecordedGraph{"intel1728.g2o", 45.004696},
                                           RecordedGraph{"intel1228.g2o", 215.830235, true}),
                         [](const auto& each) {
                           return each.param.file.substr(0, each.param.file.find('.'));
                         });

}  // namespace
}  // namespace corridor::backend
