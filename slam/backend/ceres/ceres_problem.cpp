#include "slam/backend/ceres/ceres_problem.hpp"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <type_traits>
#include <utility>
#include <vector>

#include "slam/backend/weighted_terms.hpp"
#include "slam/core/expect.hpp"

namespace corridor::backend {
namespace {

using graph::Key;
using graph::VariableKind;

constexpr int kMaxDimension = 7;
using Block = std::array<double, kMaxDimension>;

void write(const graph::Values& values, Key key, Block& block) {
  switch (key.kind) {
    case VariableKind::kPose: {
      const Pose2& pose = values.pose(key.index);
      block[0] = pose.x_m();
      block[1] = pose.y_m();
      block[2] = pose.theta_rad();
      return;
    }
    case VariableKind::kVelocity:
      Eigen::Vector2d::Map(block.data()) = values.velocity(key.index);
      return;
    case VariableKind::kBias:
      motion::ImuBias::Map(block.data()) = values.bias(key.index);
      return;
    case VariableKind::kWheelCalibration:
      motion::WheelCalibration::Map(block.data()) = values.wheel_calibration(key.index);
      return;
  }
}

void read(const Block& block, Key key, graph::Values& values) {
  switch (key.kind) {
    case VariableKind::kPose:
      return values.set_pose(key.index, {block[0], block[1], block[2]});
    case VariableKind::kVelocity:
      return values.set_velocity(key.index, {block[0], block[1]});
    case VariableKind::kBias:
      return values.set_bias(key.index, motion::ImuBias::Map(block.data()));
    case VariableKind::kWheelCalibration:
      return values.set_wheel_calibration(key.index, motion::WheelCalibration::Map(block.data()));
  }
}

// The variables, in blocks that never move, and the point that Ceres asks about.
class Variables final : public ceres::EvaluationCallback {
 public:
  double* add(Key key) {
    index_.add(key, static_cast<int>(blocks_.size()));
    return blocks_.emplace_back().data();
  }
  [[nodiscard]] const graph::VariableIndex& index() const { return index_; }
  double* block(Key key) { return blocks_[static_cast<std::size_t>(index_.of(key))].data(); }

  void set_blocks(const graph::Values& values) {
    for (std::size_t i = 0; i < blocks_.size(); ++i) write(values, index_.keys()[i], blocks_[i]);
  }
  void get_blocks(graph::Values& values) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) read(blocks_[i], index_.keys()[i], values);
  }

  [[nodiscard]] const graph::Values& point() const { return point_; }
  [[nodiscard]] bool is_point_finite() const { return is_point_finite_; }

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool is_new_point) override {
    if (!is_new_point) return;
    is_point_finite_ = std::all_of(blocks_.begin(), blocks_.end(), [](const Block& block) {
      return std::isfinite(block[0]) && std::isfinite(block[1]) && std::isfinite(block[2]);
    });
    if (is_point_finite_) get_blocks(point_);
  }

 private:
  graph::VariableIndex index_;
  std::deque<Block> blocks_;  // by number; unused entries are 0
  graph::Values point_;
  bool is_point_finite_ = true;
};

// A factor's whitened residual; the factor stays where it is.
template <class F>
class FactorCost final : public ceres::CostFunction {
 public:
  FactorCost(const graph::FactorGraph& graph, graph::FactorId id, const Variables& variables)
      : graph_(graph), id_(id), variables_(variables) {
    visit([this](const F& factor) {
      set_num_residuals(graph::num_rows(factor));
      for (const Key key : factor.keys()) {
        mutable_parameter_block_sizes()->push_back(key.dimension());
      }
    });
  }

  bool Evaluate(const double* const* /*blocks*/, double* residual,
                double** jacobians) const override {
    if (!variables_.is_point_finite()) return false;
    visit([&](const F& factor) { evaluate(factor, residual, jacobians); });
    return true;
  }

 private:
  template <class Visit>
  void visit(const Visit& visit) const {
    graph_.visit(id_, [&]<class G>(const G& factor, const graph::RobustKernel&) {
      if constexpr (std::is_same_v<F, G>) visit(factor);
    });
  }

  void evaluate(const F& factor, double* residual, double** jacobians) const {
    graph::Residual<F> r;
    if (jacobians == nullptr) {
      factor.residual(variables_.point(), r);
    } else {
      graph::Jacobian<F> J;
      factor.linearize(variables_.point(), r, J);
      for_each_key(factor, J, [&](std::size_t k, const auto& J_k) {
        if (jacobians[k] != nullptr) write_jacobian(factor.keys()[k], J_k, jacobians[k]);
      });
    }
    std::copy(r.begin(), r.end(), residual);
  }

  // Of the residual with respect to a block, row by row as Ceres stores it.
  template <class Columns>
  void write_jacobian(Key key, const Columns& J_tangent, double* jacobian) const {
    constexpr int kColumns = Columns::ColsAtCompileTime;
    constexpr int kOrder = kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor;
    Eigen::Map<Eigen::Matrix<double, F::kRows, kColumns, kOrder>> J_block(
        jacobian, J_tangent.rows(), J_tangent.cols());
    J_block = J_tangent;
    if (key.kind != VariableKind::kPose) return;
    if constexpr (kColumns == 3 || kColumns == Eigen::Dynamic) {
      const Eigen::Matrix2d R = variables_.point().oriented(key.index).rotation();
      J_block.template leftCols<2>() = J_tangent.template leftCols<2>().lazyProduct(R.transpose());
    }
  }

  const graph::FactorGraph& graph_;
  graph::FactorId id_;
  const Variables& variables_;
};

// Ceres hands over s = ||r||^2 and halves the sum: the same rho as ours.
class KernelLoss final : public ceres::LossFunction {
 public:
  explicit KernelLoss(const graph::RobustKernel& kernel) : kernel_(kernel) {}

  void Evaluate(double s, double rho[3]) const override {
    rho[0] = kernel_.cost(s);
    rho[1] = kernel_.weight(s);
    // Every kernel is concave, and a second derivative that is not positive Ceres leaves out.
    rho[2] = 0;
  }

 private:
  graph::RobustKernel kernel_;
};

ceres::Problem::Options problem_options(Variables& variables) {
  ceres::Problem::Options options;
  options.evaluation_callback = &variables;
  options.enable_fast_removal = true;
  return options;
}

}  // namespace

struct CeresProblem::Parts {
  explicit Parts(const graph::FactorGraph& graph_of_factors)
      : graph(graph_of_factors), problem(problem_options(variables)) {}

  const graph::FactorGraph& graph;
  Variables variables;
  ceres::Problem problem;
  std::vector<ceres::ResidualBlockId> residual_blocks;  // by FactorId
};

CeresProblem::CeresProblem(const graph::FactorGraph& graph)
    : parts_(std::make_unique<Parts>(graph)) {}
CeresProblem::~CeresProblem() = default;

void CeresProblem::add_variable(Key key) {
  parts_->problem.AddParameterBlock(parts_->variables.add(key), key.dimension());
}

void CeresProblem::add_factor(graph::FactorId id) {
  Parts& parts = *parts_;
  if (parts.residual_blocks.size() <= id) parts.residual_blocks.resize(id + 1);
  parts.graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    std::vector<double*> blocks;
    for (const Key key : factor.keys()) blocks.push_back(parts.variables.block(key));
    const bool is_robust = kernel.kind != graph::KernelKind::kNone;
    parts.residual_blocks[id] = parts.problem.AddResidualBlock(
        new FactorCost<F>(parts.graph, id, parts.variables),
        is_robust ? new KernelLoss(kernel) : nullptr, blocks);  // both are the problem's from here
  });
}

void CeresProblem::remove_factor(graph::FactorId id) {
  CORRIDOR_EXPECT(id < parts_->residual_blocks.size());
  CORRIDOR_EXPECT(parts_->residual_blocks[id] != nullptr);
  parts_->problem.RemoveResidualBlock(std::exchange(parts_->residual_blocks[id], nullptr));
}

const graph::VariableIndex& CeresProblem::variables() const { return parts_->variables.index(); }
const double* CeresProblem::block(Key key) const { return parts_->variables.block(key); }
void CeresProblem::set_blocks(const graph::Values& values) { parts_->variables.set_blocks(values); }
void CeresProblem::get_blocks(graph::Values& values) const { parts_->variables.get_blocks(values); }
const graph::Values& CeresProblem::last_point() const { return parts_->variables.point(); }
ceres::Problem& CeresProblem::problem() { return parts_->problem; }

}  // namespace corridor::backend
