// A dense front of the elimination: the lower triangle of the information matrix of a clique's
// variables, with the gradient as one more row below. Columns of the variables that are eliminated
// here form the panel, the rest the update that goes to the parent [Duff1983, Liu1992].
//
//            pivots   below  gradient
//   pivots [ L11                     ]
//   below  [ L21    | update         ]
//   -g     [ y^T    | u^T     | chi2 ]
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "slam/linear/block_pattern.hpp"
#include "slam/linear/front_kernels.hpp"

namespace corridor::backend {

// Scalar rows that are consecutive in a child's update and in its parent's front.
struct RowRun {
  int from = 0, to = 0, length = 0;
};

class Front {
 public:
  Front() = default;
  // In `memory`, of memory_size(num_pivots, num_below) doubles.
  Front(double* memory, int num_pivots, int num_below);
  static std::size_t memory_size(int num_pivots, int num_below);

  [[nodiscard]] int num_pivots() const { return num_pivots_; }
  [[nodiscard]] int num_below() const { return num_below_; }
  // Of L.
  [[nodiscard]] std::int64_t num_nonzeros() const {
    return std::int64_t{num_pivots_} * (num_pivots_ + 1) / 2 +
           std::int64_t{num_pivots_} * num_below_;
  }
  // Row of the gradient.
  [[nodiscard]] int last_row() const { return num_pivots_ + num_below_; }

  void set_zero();
  // Adds to rows row ... and columns column ... of the symmetric matrix; a block is either on the
  // diagonal (row == column) or wholly off it.
  template <class Block>
  void add(int row, int column, const Block& block) {
    if (row == column) {
      for (int r = 0; r < block.rows(); ++r) scale_[row + r] += block(r, r);
    }
    if (row >= column) {
      for (int c = 0; c < block.cols(); ++c) at_column(column + c, row, block.col(c));
    } else {
      for (int r = 0; r < block.rows(); ++r) at_column(row + r, column, block.row(r).transpose());
    }
  }
  // Adds the gradient of the variable at `column`.
  template <class Vector>
  void add_gradient(int column, const Vector& gradient) {
    for (int c = 0; c < gradient.rows(); ++c) column_of(column + c)[last_row()] -= gradient(c);
  }
  void add_chi2(double chi2) { column_of(last_row())[last_row()] += chi2; }
  // Adds the update of an eliminated front, whose rows go where `runs` says.
  void add_update(const Front& child, std::span<const RowRun> runs);

  // Eliminates the pivots. Returns the number of good ones: num_pivots(), or the one at which the
  // matrix showed not to be positive definite: of what its factors said on it, nothing is left that
  // its neighbours do not take away.
  int eliminate();

  // After eliminate(): column `pivot` of [L11; L21; y^T], the diagonal of L11 inverted.
  [[nodiscard]] const double* pivot_column(int pivot) const { return panel_ + pivot * stride_; }
  // Column of the update, so that row r of the front is at [r]; column >= num_pivots().
  [[nodiscard]] const double* update_column(int column) const {
    return update_ + (column - num_pivots_) * update_stride_ - num_pivots_;
  }
  // Sum of squares that is left when all pivots are at their optimum, of this front and below.
  [[nodiscard]] double chi2() const { return update_column(last_row())[last_row()]; }
  // z = y - L21^T x_below of the last solution: num_pivots() doubles that the owner keeps here.
  [[nodiscard]] double* kept_z() { return scale_; }

 private:
  double* column_of(int column) {
    return column < num_pivots_ ? panel_ + column * stride_
                                : update_ + (column - num_pivots_) * update_stride_ - num_pivots_;
  }
  template <class Column>
  void at_column(int column, int row, const Column& values) {
    double* const to = column_of(column) + row;
    for (int r = 0; r < values.rows(); ++r) to[r] += values(r);
  }

  double *panel_ = nullptr, *update_ = nullptr;
  // By row: the sum of what factors added to the diagonal, of this front and below. Those of pivots
  // make room for kept_z().
  double* scale_ = nullptr;
  int num_pivots_ = 0, num_below_ = 0;
  std::ptrdiff_t stride_ = 0, update_stride_ = 0;
};

}  // namespace corridor::backend
