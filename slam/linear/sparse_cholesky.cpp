#include "slam/linear/sparse_cholesky.hpp"

#include <cholmod.h>

#include <cmath>
#include <new>

#include "slam/core/expect.hpp"
#include "slam/linear/one_thread.hpp"

namespace corridor::linear {
namespace {

int strategy_of(CholmodMethod method) {
  switch (method) {
    case CholmodMethod::kSimplicial:
      return CHOLMOD_SIMPLICIAL;
    case CholmodMethod::kSupernodal:
      return CHOLMOD_SUPERNODAL;
    case CholmodMethod::kAuto:
      break;
  }
  return CHOLMOD_AUTO;
}

// CHOLMOD takes pointers to variables throughout, but writes through none of these.
cholmod_sparse view_of(const BlockMatrix::Scalars& lower, const double* values) {
  cholmod_sparse view{};
  view.nrow = view.ncol = to_index(lower.rows());
  view.nzmax = to_index(lower.nonZeros());
  view.p = const_cast<int*>(lower.outerIndexPtr());
  view.i = const_cast<int*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(values);
  view.stype = -1;  // what lies above the diagonal is ignored
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense view_of(double* values, Eigen::Index num_rows) {
  cholmod_dense view{};
  view.nrow = view.nzmax = view.d = to_index(num_rows);
  view.ncol = 1;
  view.x = values;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

std::vector<int> scalar_order(const std::vector<int>& order, const std::vector<int>& starts) {
  std::vector<int> rows;
  rows.reserve(to_index(starts.back()));
  for (const int variable : order) {
    const auto v = to_index(variable);
    for (int row = starts[v]; row < starts[v + 1]; ++row) rows.push_back(row);
  }
  return rows;
}

// Shows the diagonal of L to the check, in the order of elimination.
void take_diagonal(const cholmod_factor& factor, FactorDiagonal& diagonal) {
  const auto* values = static_cast<const double*>(factor.x);
  const auto* rows = static_cast<const int*>(factor.Perm);
  const auto* starts = static_cast<const int*>(factor.p);
  if (!factor.is_super) {
    for (std::size_t k = 0; k < factor.n; ++k) {
      const double entry = values[starts[k]];
      if (!diagonal.take(factor.is_ll ? entry : std::sqrt(entry), rows[k])) return;
    }
    return;
  }
  const auto* first_columns = static_cast<const int*>(factor.super);
  const auto* first_rows = static_cast<const int*>(factor.pi);
  const auto* first_values = static_cast<const int*>(factor.px);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const int height = first_rows[s + 1] - first_rows[s];
    for (int k = first_columns[s]; k < first_columns[s + 1]; ++k) {
      const int at = first_values[s] + (k - first_columns[s]) * (height + 1);
      if (!diagonal.take(values[at], rows[k])) return;
    }
  }
}

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *workspace = nullptr, *small_workspace = nullptr;  // of solutions
  std::vector<double> damped;                                      // values of the matrix

  explicit Impl(CholmodMethod method) {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = strategy_of(method);
    common.supernodal_switch = kSupernodalSwitch;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = 1;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    cholmod_free_dense(&workspace, &common);
    cholmod_free_dense(&small_workspace, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const double* damped_values(const BlockMatrix::Scalars& lower,
                              const std::vector<int>& block_starts, double damping) {
    damped.assign(lower.valuePtr(), lower.valuePtr() + lower.nonZeros());
    for (std::size_t v = 0; v + 1 < block_starts.size(); ++v) {
      for (int row = block_starts[v]; row < block_starts[v + 1]; ++row) {
        damped[to_index(lower.outerIndexPtr()[row] + row - block_starts[v])] *= 1 + damping;
      }
    }
    return damped.data();
  }
};

SparseCholesky::SparseCholesky(CholmodMethod method) : impl_(std::make_unique<Impl>(method)) {}
SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::analyze(const BlockMatrix& matrix, const std::vector<int>& order) {
  std::vector<int> rows = scalar_order(order, matrix.starts());
  const BlockMatrix::Scalars lower = matrix.scalars();
  cholmod_sparse view = view_of(lower, lower.valuePtr());
  cholmod_free_factor(&impl_->factor, &impl_->common);
  impl_->factor = cholmod_analyze_p(&view, rows.data(), nullptr, 0, &impl_->common);
  if (impl_->factor == nullptr) throw std::bad_alloc();
}

int SparseCholesky::eliminate(const BlockMatrix& matrix, double damping) {
  const BlockMatrix::Scalars lower = matrix.scalars();
  const double* values =
      damping > 0 ? impl_->damped_values(lower, matrix.starts(), damping) : lower.valuePtr();
  cholmod_sparse view = view_of(lower, values);
  const OneThread one_thread;
  cholmod_factorize(&view, impl_->factor, &impl_->common);
  // Also if the factor has more entries than CHOLMOD can count.
  if (impl_->common.status < CHOLMOD_OK) throw std::bad_alloc();
  const cholmod_factor& factor = *impl_->factor;
  if (factor.minor < factor.n) return static_cast<const int*>(factor.Perm)[factor.minor];
  FactorDiagonal diagonal;
  take_diagonal(factor, diagonal);
  return diagonal.bad_row();
}

void SparseCholesky::substitute(const Eigen::Ref<const Eigen::MatrixXd>& b,
                                Eigen::Ref<Eigen::MatrixXd>& x) {
  for (Eigen::Index c = 0; c < b.cols(); ++c) {
    cholmod_dense b_view = view_of(const_cast<double*>(b.col(c).data()), b.rows());
    cholmod_dense x_view = view_of(x.col(c).data(), x.rows());
    cholmod_dense* solution = &x_view;
    const int is_solved =
        cholmod_solve2(CHOLMOD_A, impl_->factor, &b_view, nullptr, &solution, nullptr,
                       &impl_->workspace, &impl_->small_workspace, &impl_->common);
    CORRIDOR_ENSURE(is_solved && solution == &x_view);
  }
}

double SparseCholesky::num_factor_nonzeros() const { return impl_->common.lnz; }
double SparseCholesky::num_flops() const { return impl_->common.fl; }

}  // namespace corridor::linear
