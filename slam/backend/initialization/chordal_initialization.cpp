#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/linear/make_linear_solver.hpp"

namespace corridor::backend {
namespace {

using Edges = std::vector<const graph::RelativePose*>;

// Linear least squares over a plane vector per free pose: min sum || r + A_i d_i + A_j d_j ||^2.
class VectorsOfPoses {
 public:
  // `order` has the held poses without an edge; they get no unknown.
  VectorsOfPoses(const std::vector<Placement>& order, const Edges& edges) {
    for (const Placement& step : order) {
      if (step.pose >= unknown_of_.size()) unknown_of_.resize(step.pose + 1, kHeld);
      if (step.edge != nullptr) poses_.push_back(step.pose);
    }
    for (const std::uint32_t pose : poses_) unknown_of_[pose] = matrix_.add_variable(2);
    for (const graph::RelativePose* edge : edges) slots_.push_back(slots_of(*edge));
    start();
  }

  [[nodiscard]] bool is_empty() const { return poses_.empty(); }
  [[nodiscard]] bool is_held(std::uint32_t pose) const { return unknown_of_[pose] == kHeld; }

  void start() {
    matrix_.set_zero();
    gradient_.setZero(matrix_.num_rows());
  }

  // The terms of the edge of that number, A = (A_i, A_j).
  template <int kRows>
  void add(std::size_t edge, const Eigen::Matrix<double, kRows, 4>& A,
           const Eigen::Matrix<double, kRows, 1>& r) {
    const Slots& at = slots_[edge];
    const auto A_i = A.template leftCols<2>();
    const auto A_j = A.template rightCols<2>();
    if (at.i != kHeld) {
      matrix_.add(at.diagonal_i, A_i.transpose() * A_i);
      gradient_.segment<2>(2 * at.i) += A_i.transpose() * r;
    }
    if (at.j != kHeld) {
      matrix_.add(at.diagonal_j, A_j.transpose() * A_j);
      gradient_.segment<2>(2 * at.j) += A_j.transpose() * r;
    }
    if (at.i == kHeld || at.j == kHeld) return;
    if (at.i > at.j) {
      matrix_.add(at.mixed, A_i.transpose() * A_j);
    } else {
      matrix_.add(at.mixed, A_j.transpose() * A_i);
    }
  }

  // Calls visit(pose, d) for every free pose.
  template <class Visit>
  Result<void> solve(const Visit& visit) {
    if (solver_->factorize(matrix_) != linear::CholeskyStatus::kOk) return failure();
    Eigen::VectorXd d(gradient_.rows());
    solver_->solve(-gradient_, d);
    if (!d.allFinite()) {
      return fail(ErrorCode::kInvalid, "the solution is not finite", "chordal initialisation",
                  "edges of a drive, in metres");
    }
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      visit(poses_[k], Eigen::Vector2d(d.segment<2>(2 * static_cast<Eigen::Index>(k))));
    }
    return {};
  }

 private:
  static constexpr int kHeld = -1;
  struct Slots {
    int i = kHeld, j = kHeld;
    std::size_t diagonal_i = 0, diagonal_j = 0, mixed = 0;
  };

  Slots slots_of(const graph::RelativePose& edge) {
    Slots at{unknown_of_[edge.keys()[0].index], unknown_of_[edge.keys()[1].index]};
    if (at.i != kHeld) at.diagonal_i = matrix_.slot(at.i, at.i);
    if (at.j != kHeld) at.diagonal_j = matrix_.slot(at.j, at.j);
    if (at.i != kHeld && at.j != kHeld) {
      at.mixed = matrix_.slot(std::max(at.i, at.j), std::min(at.i, at.j));
    }
    return at;
  }

  [[nodiscard]] tl::unexpected<Error> failure() const {
    const int bad = solver_->first_bad_variable();
    if (bad < 0) return fail(ErrorCode::kResourceLimit, "out of memory", "chordal initialisation");
    const graph::Key pose = graph::pose_key(poses_[static_cast<std::size_t>(bad)]);
    return fail(ErrorCode::kInvalid, graph::to_text(pose) + " is undetermined",
                "chordal initialisation", "edges whose information determines every pose");
  }

  std::vector<std::uint32_t> poses_;  // by unknown
  std::vector<int> unknown_of_;       // by pose
  std::vector<Slots> slots_;          // by edge
  linear::BlockMatrix matrix_;
  Eigen::VectorXd gradient_;
  std::unique_ptr<linear::LinearSolver> solver_ =
      linear::make_linear_solver(linear::LinearSolverKind::kBlock);
};

// Headings of all free poses; their positions become zero.
Result<void> solve_headings(const Edges& edges, VectorsOfPoses& unknowns, graph::Values& values) {
  const auto held_direction = [&](std::uint32_t pose) -> Eigen::Vector2d {
    if (!unknowns.is_held(pose)) return Eigen::Vector2d::Zero();
    return {values.oriented(pose).cosine, values.oriented(pose).sine};
  };
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const graph::RelativePose& edge = *edges[k];
    const double weight = std::sqrt(edge.information()(2, 2));
    const Eigen::Matrix2d R_i_j = edge.measured_T_i_j().rotation();
    Eigen::Matrix<double, 2, 4> A;
    A << -weight * R_i_j, weight * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d r = A.leftCols<2>() * held_direction(edge.keys()[0].index) +
                              A.rightCols<2>() * held_direction(edge.keys()[1].index);
    unknowns.add<2>(k, A, r);
  }
  return unknowns.solve([&](std::uint32_t pose, const Eigen::Vector2d& x) {
    values.set_pose(pose, {0, 0, std::atan2(x.y(), x.x())});
  });
}

// Positions of all free poses, which are at zero, for the headings they have. The residual is
// linear in them.
Result<void> solve_positions(const Edges& edges, VectorsOfPoses& unknowns, graph::Values& values) {
  unknowns.start();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    Eigen::Vector3d r;
    Eigen::Matrix<double, 3, 6> J;
    edges[k]->linearize(values, r, J);
    Eigen::Matrix<double, 3, 4> A;
    A << J.leftCols<2>(), J.middleCols<2>(3);
    unknowns.add<3>(k, A, r);
  }
  return unknowns.solve([&](std::uint32_t pose, const Eigen::Vector2d& d) {
    values.retract(graph::pose_key(pose), Eigen::Vector3d(d.x(), d.y(), 0).data());
  });
}

}  // namespace

Result<graph::Values> chordal_initialization(const graph::FactorGraph& graph,
                                             const graph::Values& values,
                                             std::span<const std::uint32_t> held) {
  const auto order = spanning_order(graph, values, held);
  if (!order) return tl::make_unexpected(order.error());
  const Edges edges = relative_poses(graph);
  VectorsOfPoses unknowns(*order, edges);
  graph::Values placed = values;
  if (unknowns.is_empty()) return placed;
  Result<void> done = solve_headings(edges, unknowns, placed);
  if (done) done = solve_positions(edges, unknowns, placed);
  if (!done) return tl::make_unexpected(done.error());
  return placed;
}

}  // namespace corridor::backend
