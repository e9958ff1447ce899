#include "datasets/formats/graphs/pose_graph_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "datasets/formats/graphs/g2o_file.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::ScratchFolder;
using test::write_text;

bool same(const PoseGraph& a, const PoseGraph& b) {
  const auto same_vertex = [](const PoseGraph::Vertex& v, const PoseGraph::Vertex& w) {
    return v.id == w.id && v.T_map_base == w.T_map_base;
  };
  const auto same_edge = [](const PoseGraph::Edge& e, const PoseGraph::Edge& f) {
    return e.i == f.i && e.j == f.j && e.T_i_j == f.T_i_j && e.information == f.information;
  };
  return std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    same_vertex) &&
         std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), same_edge) &&
         a.fixed == b.fixed;
}

double fraction() { return *rc::gen::inRange(-1'000'000, 1'000'000) / 3e5; }

// Any chain with closures; information = A^T A + 1, so that it is positive definite.
PoseGraph any_graph() {
  PoseGraph graph;
  const auto num_poses = *rc::gen::inRange<std::uint32_t>(2, 8);
  const auto stride = *rc::gen::inRange<std::uint32_t>(1, 1000);
  for (std::uint32_t i = 0; i < num_poses; ++i) {
    graph.vertices.push_back({i * stride, Pose2(fraction(), fraction(), fraction())});
  }
  const auto num_edges = *rc::gen::inRange(0, 12);
  for (int k = 0; k < num_edges; ++k) {
    const auto i = *rc::gen::inRange<std::uint32_t>(0, num_poses);
    const auto step = *rc::gen::inRange<std::uint32_t>(1, num_poses);
    Eigen::Matrix3d a;
    for (double& value : a.reshaped()) value = fraction();
    const Eigen::Matrix3d information = a.transpose() * a + Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d symmetric = information.selfadjointView<Eigen::Upper>();
    graph.edges.push_back({i * stride, (i + step) % num_poses * stride,
                           Pose2(fraction(), fraction(), fraction()), symmetric});
  }
  return graph;
}

RC_GTEST_PROP(PoseGraphFile, ReadUndoesWriteInEachFormat, ()) {
  PoseGraph graph = any_graph();
  for (const GraphFormat format : {GraphFormat::kG2o, GraphFormat::kToro}) {
    const auto read = parse_pose_graph(pose_graph_text(graph, format), format, "g");
    RC_ASSERT(read.has_value());
    RC_ASSERT(same(*read, graph));
  }
  graph.fixed = {graph.vertices.back().id, graph.vertices.front().id};
  const auto read =
      parse_pose_graph(pose_graph_text(graph, GraphFormat::kG2o), GraphFormat::kG2o, "g");
  RC_ASSERT(read.has_value() && same(*read, graph));
}

RC_GTEST_PROP(PoseGraphFile, TheWayThroughToroAndBackChangesNoNumber, ()) {
  const PoseGraph graph = any_graph();
  const auto toro =
      parse_pose_graph(pose_graph_text(graph, GraphFormat::kToro), GraphFormat::kToro, "g");
  RC_ASSERT(toro.has_value());
  RC_ASSERT(pose_graph_text(*toro, GraphFormat::kG2o) == pose_graph_text(graph, GraphFormat::kG2o));
}

TEST(PoseGraphFile, EachFormatHasItsOwnOrderOfInformation) {
  const auto g2o = parse_pose_graph(
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 2 3\nEDGE_SE2 0 1 1 2 3 11 0.12 0.13 22 0.23 33\n",
      GraphFormat::kG2o, "g");
  const auto toro = parse_pose_graph(
      "VERTEX2 0 0 0 0\nVERTEX2 1 1 2 3\nEDGE2 0 1 1 2 3 11 0.12 22 33 0.13 0.23\n",
      GraphFormat::kToro, "g");
  ASSERT_TRUE(g2o.has_value() && toro.has_value());
  Eigen::Matrix3d expected;
  expected << 11, 0.12, 0.13, 0.12, 22, 0.23, 0.13, 0.23, 33;
  EXPECT_EQ(g2o->edges[0].information, expected);
  EXPECT_TRUE(same(*g2o, *toro));
}

TEST(PoseGraphFile, SolversGetG2osChi2) {
  const auto graph = parse_pose_graph(
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 7 1 0 0.5\nEDGE_SE2 0 7 0.5 0 0 2 0 1 3 0 4\n",
      GraphFormat::kG2o, "g");
  ASSERT_TRUE(graph.has_value());
  const GraphProblem problem = factor_graph_of(*graph);
  // e = (0.5, 0, 0.5): 2 * 0.25 + 2 * 1 * 0.25 + 4 * 0.25.
  EXPECT_NEAR(problem.factors.chi2(problem.values), 2.0, 1e-12);
}

TEST(PoseGraphFile, ReadsBackWhatASystemSolved) {
  const auto graph = parse_pose_graph(
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.5\nEDGE_SE2 0 1 0.5 0 0 2 0 1 3 0 4\n",
      GraphFormat::kG2o, "g");
  const GraphProblem problem = factor_graph_of(*graph);
  const ScratchFolder folder;
  ASSERT_TRUE(write_g2o(problem.factors, problem.values, folder / "solved.g2o"));
  const auto read = read_pose_graph(folder / "solved.g2o");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->fixed, std::vector<std::uint32_t>{0});
  const GraphProblem again = factor_graph_of(*read);
  EXPECT_NEAR(again.factors.chi2(again.values), problem.factors.chi2(problem.values), 1e-12);
}

constexpr const char* kTwoPoses = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";

void expect_refused(const std::string& text, const std::string& where, const std::string& what,
                    GraphFormat format = GraphFormat::kG2o) {
  const auto read = parse_pose_graph(text, format, "g");
  ASSERT_FALSE(read.has_value()) << text;
  const std::string line = read.error().to_line();
  EXPECT_EQ(line.find(where), 0U) << line;
  EXPECT_NE(line.find(what), std::string::npos) << line;
  EXPECT_NE(line.find("; expected "), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

TEST(PoseGraphFile, RefusesAPoseWithoutVertex) {
  expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 5 1 0 0 1 0 0 1 0 1\n",
                 "g:3: ", "pose 5 has no vertex");
  expect_refused(std::string(kTwoPoses) + "FIX 9\n", "g:3: ", "pose 9 has no vertex");
}

TEST(PoseGraphFile, RefusesAVertexGivenTwice) {
  expect_refused(std::string(kTwoPoses) + "VERTEX_SE2 1 1 0 0\n",
                 "g:3: ", "vertex 1 stands in line 2 already");
  expect_refused(std::string(kTwoPoses) + "FIX 1 1\n", "g:3: ", "pose 1 is fixed in line 3");
}

TEST(PoseGraphFile, RefusesNumbersThatAreNone) {
  for (const std::string bad : {"nan", "inf", "-inf", "1e999", "1,5", "x"}) {
    expect_refused("VERTEX_SE2 0 0 " + bad + " 0\n", "g:1: ", "'" + bad + "'");
    expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 " + bad + " 1 0 0 1 0 1\n",
                   "g:3: ", "'" + bad + "'");
    expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 " + bad + "\n",
                   "g:3: ", "'" + bad + "'");
  }
}

TEST(PoseGraphFile, RefusesNegativeInformation) {
  const std::string head = std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 0 ";
  expect_refused(head + "-1 0 0 1 0 1\n", "g:3: ", "eigenvalue -1");
  expect_refused(head + "1 2 0 1 0 1\n", "g:3: ", "eigenvalue -1");
  // The order of the other format gives a matrix that is none.
  expect_refused(head + "44 1 376 9807 0 0\n", "g:3: ", "eigenvalue -");
}

TEST(PoseGraphFile, CountsSingularInformation) {
  const auto read = parse_pose_graph(std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 0 0 0 0 1 0 1\n",
                                     GraphFormat::kG2o, "g");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_NE(read->notes[0].find("1 edges with singular information"), std::string::npos);
}

TEST(PoseGraphFile, RefusesTruncatedLinesAndFurtherFields) {
  expect_refused("VERTEX_SE2 0 0 0", "g:1: ", "4 fields");
  expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0", "g:3: ", "11 fields");
  expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 7\n",
                 "g:3: ", "13 fields");
  expect_refused(std::string(kTwoPoses) + "FIX\n", "g:3: ", "FIX of no pose");
}

TEST(PoseGraphFile, RefusesAbsurdIdsBeforeAllocating) {
  for (const std::string bad : {"4294967295", "-1", "4194304", "99999999999999999999", "1.5"}) {
    expect_refused("VERTEX_SE2 " + bad + " 0 0 0\n", "g:1: ", "id '" + bad + "'");
    expect_refused(std::string(kTwoPoses) + "EDGE_SE2 0 " + bad + " 1 0 0 1 0 0 1 0 1\n",
                   "g:3: ", "id '" + bad + "'");
  }
}

TEST(PoseGraphFile, RefusesAnEdgeFromAPoseToItself) {
  expect_refused(std::string(kTwoPoses) + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n", "g:3: ", "itself");
}

TEST(PoseGraphFile, RefusesTheWordsOfTheOtherFormat) {
  expect_refused("VERTEX2 0 0 0 0\n", "g:1: ", "'VERTEX2'");
  expect_refused("VERTEX_SE2 0 0 0 0\n", "g:1: ", "'VERTEX_SE2'", GraphFormat::kToro);
  expect_refused("VERTEX2 0 0 0 0\nFIX 0\n", "g:2: ", "'FIX'", GraphFormat::kToro);
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", "g:1: ", "'VERTEX_SE3:QUAT'");
}

TEST(PoseGraphFile, RefusesAGraphWithoutVertex) {
  expect_refused("", "g: ", "no vertex");
  expect_refused("# nothing\n\n", "g: ", "no vertex");
  expect_refused(std::string(1000, '\x01'), "g:1: ", "line of kind");
}

TEST(PoseGraphFile, CountsWhatItLetsThrough) {
  const auto read =
      parse_pose_graph(std::string(kTwoPoses) +
                           "VERTEX_SE2 2 0 0 7\n"
                           "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 0 1 0 0 1 0 0 1 0 1",
                       GraphFormat::kG2o, "g");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->notes,
            (std::vector<std::string>{"1 edges repeat a pair of poses; all are kept",
                                      "1 angles wrapped to (-pi, pi]", "2 parts that no edge joins",
                                      "the last line has no end: the file may have been cut "
                                      "short"}));
}

TEST(PoseGraphFile, NotesAnglesThatLookLikeDegrees) {
  std::string text;
  for (int i = 0; i < 8; ++i) text += fmt::format("VERTEX_SE2 {} {} 0 {}\n", i, i, 45 * i - 180);
  for (int i = 1; i < 8; ++i) text += fmt::format("EDGE_SE2 {} {} 1 0 0 1 0 0 1 0 1\n", i - 1, i);
  const auto read = parse_pose_graph(text, GraphFormat::kG2o, "g");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->notes.back(), "7 of 15 angles are beyond 2 pi: degrees for radians?");
}

TEST(PoseGraphFile, ToroHoldsNoFixedPoses) {
  PoseGraph graph;
  graph.vertices = {{0, Pose2()}, {1, Pose2()}};
  EXPECT_TRUE(losses_of_conversion(graph, GraphFormat::kToro).empty());
  graph.fixed = {1};
  EXPECT_EQ(losses_of_conversion(graph, GraphFormat::kToro).size(), 1U);
  EXPECT_TRUE(losses_of_conversion(graph, GraphFormat::kG2o).empty());
}

struct GraphCounts {
  const char* file;
  std::size_t num_poses;
  std::size_t num_edges;
  std::size_t num_repeated_pairs;
};

// For the tests' names.
std::ostream& operator<<(std::ostream& stream, const GraphCounts& counts) {
  return stream << counts.file;
}

class PublishedGraphs : public ::testing::TestWithParam<GraphCounts> {};

// Counts of the files as published.
TEST_P(PublishedGraphs, HaveTheirKnownCountsAndSurviveTheWayThroughTheOtherFormat) {
  const std::string name = std::string("graphs/") + GetParam().file;
  const auto file = testing::recorded_file(name);
  if (!file) GTEST_SKIP() << testing::missing_data_message(name);
  const auto graph = read_pose_graph(*file);
  ASSERT_TRUE(graph.has_value()) << graph.error().to_line();
  EXPECT_EQ(graph->vertices.size(), GetParam().num_poses);
  EXPECT_EQ(graph->edges.size(), GetParam().num_edges);
  EXPECT_EQ(num_repeated_pairs(*graph), GetParam().num_repeated_pairs);
  EXPECT_EQ(num_parts(*graph), 1U);
  const GraphFormat own = *graph_format_from_suffix(*file);
  const GraphFormat other = own == GraphFormat::kG2o ? GraphFormat::kToro : GraphFormat::kG2o;
  const auto through = parse_pose_graph(pose_graph_text(*graph, other), other, "g");
  ASSERT_TRUE(through.has_value());
  EXPECT_TRUE(same(*graph, *through));
}

INSTANTIATE_TEST_SUITE_P(PoseGraphFile, PublishedGraphs,
                         ::testing::Values(GraphCounts{"M3500.g2o", 3500, 5453, 0},
                                           GraphCounts{"manhattanOlson3500.g2o", 3500, 5598, 145},
                                           GraphCounts{"M3500b.g2o", 3500, 5453, 0},
                                           GraphCounts{"city10000.g2o", 10000, 20687, 0},
                                           GraphCounts{"intel1728.g2o", 1728, 2512, 0},
                                           GraphCounts{"intel1228.g2o", 1228, 1483, 0},
                                           GraphCounts{"MIT.g2o", 808, 827, 0},
                                           GraphCounts{"CSAIL.graph", 1045, 1172, 1},
                                           GraphCounts{"FRH.graph", 1316, 2820, 0}));

}  // namespace
}  // namespace corridor::formats
