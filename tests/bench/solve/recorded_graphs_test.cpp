// The graphs of the literature, solved to the best chi2 that is known for them: the smallest that
// several independent programs agree on.
#include <gtest/gtest.h>

#include <string>

#include "bench/solve/solve_graph.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::solve {
namespace {

struct Graph {
  const char* file;
  double best_chi2;
  // Where plain Gauss-Newton gets there from.
  Initialization init = Initialization::kFile;
};

std::ostream& operator<<(std::ostream& out, const Graph& graph) { return out << graph.file; }

class RecordedGraphs : public ::testing::TestWithParam<Graph> {
 protected:
  void SetUp() override {
    const std::string name = std::string("graphs/") + GetParam().file;
    const auto path = testing::recorded_file(name);
    if (!path) GTEST_SKIP() << testing::missing_data_message(name);
    auto read = formats::read_pose_graph(*path);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    graph_ = std::move(*read);
  }

  formats::PoseGraph graph_;
};

class SolvedAtOnce : public RecordedGraphs {};
class SolvedPoseByPose : public RecordedGraphs {};

TEST_P(SolvedAtOnce, ByGaussNewtonWithBothLinearSolvers) {
  for (const char* const linear : {"block", "cholmod"}) {
    backend::LeastSquaresParams params;
    params.linear = linear;
    const auto back_end = backend::make_least_squares(params);
    const auto run = solve_graph(graph_, *back_end, {.init = GetParam().init});
    ASSERT_TRUE(run.has_value()) << run.error().to_line();
    EXPECT_EQ(run->status, backend::SolveStatus::kConverged);
    // The best values are known to four decimals.
    EXPECT_NEAR(*run->chi2, GetParam().best_chi2, 1e-6 * GetParam().best_chi2 + 6e-5);
  }
}

TEST_P(SolvedPoseByPose, ByIsam2) {
  const auto back_end = backend::make_isam2({});
  const auto run = solve_graph(graph_, *back_end, {.mode = Mode::kIncremental});
  ASSERT_TRUE(run.has_value()) << run.error().to_line();
  EXPECT_EQ(run->updates_s.size(), graph_.vertices.size());
  constexpr double kHalfAPerMille = 5e-4;
  EXPECT_NEAR(*run->chi2, GetParam().best_chi2, kHalfAPerMille * GetParam().best_chi2 + 6e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Graphs, SolvedAtOnce,
    ::testing::Values(Graph{"M3500.g2o", 137.9130}, Graph{"manhattanOlson3500.g2o", 146.0766},
                      Graph{"city10000.g2o", 511.9852}, Graph{"CSAIL.graph", 38.9563},
                      Graph{"FRH.graph", 0.0002}, Graph{"intel1228.g2o", 215.8302},
                      Graph{"intel1728.g2o", 45.0047},
                      // From odometry they end in local minima.
                      Graph{"MIT.g2o", 41.1633, Initialization::kChordal},
                      Graph{"M3500b.g2o", 2054.7159, Initialization::kChordal}));
INSTANTIATE_TEST_SUITE_P(
    Graphs, SolvedPoseByPose,
    ::testing::Values(Graph{"M3500.g2o", 137.9130}, Graph{"manhattanOlson3500.g2o", 146.0766},
                      Graph{"CSAIL.graph", 38.9563}, Graph{"FRH.graph", 0.0002},
                      Graph{"intel1228.g2o", 215.8302}, Graph{"intel1728.g2o", 45.0047},
                      Graph{"MIT.g2o", 41.1633}, Graph{"M3500b.g2o", 2054.7159}));

}  // namespace
}  // namespace corridor::solve
