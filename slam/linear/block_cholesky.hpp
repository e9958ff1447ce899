// Multifrontal Cholesky factorisation of a block matrix [Duff1983, Liu1992]: supernodes are dense
// fronts, eliminated one behind the other. A factorisation or solution with an unchanged pattern
// allocates nothing. Deliberately serial, in memory, without pivoting.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "slam/linear/front_layout.hpp"
#include "slam/linear/linear_solver.hpp"

namespace corridor::linear {

class BlockCholesky final : public LinearSolver {
 public:
  [[nodiscard]] std::string_view name() const override { return "block"; }
  [[nodiscard]] double num_factor_nonzeros() const override { return layout_.num_nonzeros; }
  [[nodiscard]] double num_flops() const override { return layout_.num_flops; }
  [[nodiscard]] const FrontLayout& layout() const { return layout_; }

 private:
  // The update of a front that its parent has not taken yet.
  struct Waiting {
    const Front* front;
    double* update;
  };

  void analyze(const BlockMatrix& matrix, const std::vector<int>& order) override;
  int eliminate(const BlockMatrix& matrix, double damping) override;
  void substitute(const Eigen::Ref<const Eigen::MatrixXd>& b,
                  Eigen::Ref<Eigen::MatrixXd>& x) override;

  void copy_blocks(const Front& front, const double* values, double damping);
  double* add_children(const Front& front, double* update);
  void add_update(const Waiting& child, const Front& front, double* update);
  bool factorize_front(const Front& front, FactorDiagonal& diagonal);
  void solve_lower();
  void solve_upper();

  FrontLayout layout_;
  std::vector<double> panels_;      // L, its diagonal inverted
  std::vector<double> updates_;     // a stack
  std::vector<Waiting> waiting_;    // the updates in it, bottom first
  std::vector<double> solution_;    // in the order of elimination
  std::vector<double> front_rows_;  // of that solution, those of one front
};

}  // namespace corridor::linear
