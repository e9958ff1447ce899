#include "slam/linear/block_cholesky.hpp"

#include <algorithm>

#include "slam/linear/front_kernels.hpp"

namespace corridor::linear {
namespace {

void add_run(const double* from, const RowRun& run, int first, double* to) {
  for (int r = first; r < run.length; ++r) to[run.to + r] += from[run.from + r];
}

}  // namespace

void BlockCholesky::analyze(const BlockMatrix& matrix, const std::vector<int>& order) {
  layout_ = lay_out_fronts(matrix, order);
  panels_.resize(to_index(layout_.panels_size));
  updates_.resize(to_index(layout_.stack_size));
  waiting_.reserve(layout_.fronts.size());
  solution_.resize(layout_.row_order.size());
  front_rows_.resize(to_index(layout_.max_rows + kFrontPadding));
}

int BlockCholesky::eliminate(const BlockMatrix& matrix, double damping) {
  const double* values = matrix.scalars().valuePtr();
  FactorDiagonal diagonal;
  waiting_.clear();
  double* top = updates_.data();
  for (const Front& front : layout_.fronts) {
    copy_blocks(front, values, damping);
    std::fill_n(top, front.update_size(), 0.0);
    double* const bottom = add_children(front, top);
    if (!factorize_front(front, diagonal)) break;
    const double* panel = panels_.data() + front.panel;
    subtract_outer_product(panel, front.stride, front.num_rows, front.num_pivots, top,
                           front.update_stride());
    // Its children's updates are used up: its own takes their place.
    if (bottom != top) std::copy_n(top, front.update_size(), bottom);
    if (front.has_parent) waiting_.push_back({&front, bottom});
    top = bottom + front.update_size();
  }
  return diagonal.bad_row();
}

void BlockCholesky::copy_blocks(const Front& front, const double* values, double damping) {
  double* const panel = panels_.data() + front.panel;
  std::fill_n(panel, front.panel_size(), 0.0);
  for (std::size_t i = front.first_copy; i < front.end_copy; ++i) {
    const BlockCopy& copy = layout_.copies[i];
    for (int c = 0; c < copy.num_columns; ++c) {
      const double* from = values + copy.from + c * copy.from_stride;
      double* to = panels_.data() + copy.to + c * copy.column_step;
      for (int r = 0; r < copy.num_rows; ++r) to[r * copy.row_step] = from[r];
    }
  }
  if (damping == 0) return;
  for (int k = 0; k < front.num_pivots; ++k) panel[k * (front.stride + 1)] *= 1 + damping;
}

// Adds the updates of the front's children to its panel and, for columns beyond its pivots, to its
// own update. Returns where the lowest of them lay in the stack.
double* BlockCholesky::add_children(const Front& front, double* update) {
  double* bottom = update;
  for (int c = 0; c < front.num_children; ++c) {
    bottom = waiting_.back().update;
    add_update(waiting_.back(), front, update);
    waiting_.pop_back();
  }
  return bottom;
}

void BlockCholesky::add_update(const Waiting& child, const Front& front, double* update) {
  double* const panel = panels_.data() + front.panel;
  const std::ptrdiff_t child_stride = child.front->update_stride();
  const std::ptrdiff_t update_stride = front.update_stride();
  const RowRun* const end = layout_.joins.data() + child.front->end_join;
  for (const RowRun* columns = layout_.joins.data() + child.front->first_join; columns != end;
       ++columns) {
    for (int c = 0; c < columns->length; ++c) {
      const double* from = child.update + (columns->from + c) * child_stride;
      const int column = columns->to + c;
      double* to = column < front.num_pivots
                       ? panel + column * front.stride
                       : update + (column - front.num_pivots) * update_stride - front.num_pivots;
      add_run(from, *columns, c, to);
      for (const RowRun* rows = columns + 1; rows != end; ++rows) add_run(from, *rows, 0, to);
    }
  }
}

bool BlockCholesky::factorize_front(const Front& front, FactorDiagonal& diagonal) {
  double* const panel = panels_.data() + front.panel;
  const int num_good = factorize_panel(panel, front.stride, front.num_rows, front.num_pivots);
  const int* rows = layout_.row_order.data() + front.first_pivot;
  for (int k = 0; k < num_good; ++k) {
    if (!diagonal.take(1 / panel[k * (front.stride + 1)], rows[k])) return false;
  }
  return num_good == front.num_pivots || diagonal.take(0, rows[num_good]);
}

void BlockCholesky::substitute(const Eigen::Ref<const Eigen::MatrixXd>& b,
                               Eigen::Ref<Eigen::MatrixXd>& x) {
  const std::vector<int>& order = layout_.row_order;
  for (Eigen::Index c = 0; c < b.cols(); ++c) {
    for (std::size_t k = 0; k < order.size(); ++k) solution_[k] = b(order[k], c);
    solve_lower();
    solve_upper();
    for (std::size_t k = 0; k < order.size(); ++k) x(order[k], c) = solution_[k];
  }
}

void BlockCholesky::solve_lower() {
  double* const x = front_rows_.data();
  for (const Front& front : layout_.fronts) {
    std::copy_n(solution_.data() + front.first_pivot, front.num_pivots, x);
    std::fill_n(x + front.num_pivots, front.num_below() + kFrontPadding, 0.0);
    solve_panel(panels_.data() + front.panel, front.stride, front.num_rows, front.num_pivots, x);
    std::copy_n(x, front.num_pivots, solution_.data() + front.first_pivot);
    for (std::size_t i = front.first_run; i < front.end_run; ++i) {
      add_run(x, layout_.runs[i], 0, solution_.data());
    }
  }
}

void BlockCholesky::solve_upper() {
  double* const x = front_rows_.data();
  for (std::size_t s = layout_.fronts.size(); s-- > 0;) {
    const Front& front = layout_.fronts[s];
    std::copy_n(solution_.data() + front.first_pivot, front.num_pivots, x);
    for (std::size_t i = front.first_run; i < front.end_run; ++i) {
      const RowRun& run = layout_.runs[i];
      std::copy_n(solution_.data() + run.to, run.length, x + run.from);
    }
    std::fill_n(x + front.num_rows, kFrontPadding, 0.0);
    solve_transposed_panel(panels_.data() + front.panel, front.stride, front.num_rows,
                           front.num_pivots, x);
    std::copy_n(x, front.num_pivots, solution_.data() + front.first_pivot);
  }
}

}  // namespace corridor::linear
