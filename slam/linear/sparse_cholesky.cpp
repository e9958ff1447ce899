#include "slam/linear/sparse_cholesky.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::linear {
namespace {

// Smallest accepted ratio of the factor's diagonal entries, squared: below it the matrix counts as
// rank deficient, since the solution would have no correct digit left.
constexpr double kMinReciprocalCondition = 1e-15;

cholmod_sparse view_of(const Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(lower.rows());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = const_cast<int*>(lower.outerIndexPtr());
  view.i = const_cast<int*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

// Pattern of the blocks' graph, lower triangle, one scalar entry per block pair.
Eigen::SparseMatrix<double> block_pattern(const Eigen::SparseMatrix<double>& lower,
                                          std::span<const int> block_starts) {
  const int num_blocks = static_cast<int>(block_starts.size()) - 1;
  std::vector<int> block_of_row(static_cast<std::size_t>(lower.rows()));
  for (int b = 0; b < num_blocks; ++b) {
    std::fill(block_of_row.begin() + block_starts[static_cast<std::size_t>(b)],
              block_of_row.begin() + block_starts[static_cast<std::size_t>(b) + 1], b);
  }
  Eigen::SparseMatrix<double> pattern(num_blocks, num_blocks);
  pattern.reserve(lower.nonZeros() / 4 + num_blocks);
  for (int b = 0; b < num_blocks; ++b) {
    pattern.startVec(b);
    int last = -1;
    const int column = block_starts[static_cast<std::size_t>(b)];
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
      const int row_block = block_of_row[static_cast<std::size_t>(it.row())];
      if (row_block != last) pattern.insertBack(row_block, b) = 1;
      last = row_block;
    }
  }
  pattern.finalize();
  return pattern;
}

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<int> outer, inner;  // pattern of the last analysis
  int num_analyses = 0;
  int first_bad_column = -1;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.postorder = 1;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  bool has_pattern_of(const Eigen::SparseMatrix<double>& lower) const {
    return factor != nullptr && outer.size() == static_cast<std::size_t>(lower.cols()) + 1 &&
           inner.size() == static_cast<std::size_t>(lower.nonZeros()) &&
           std::equal(outer.begin(), outer.end(), lower.outerIndexPtr()) &&
           std::equal(inner.begin(), inner.end(), lower.innerIndexPtr());
  }

  bool analyze(const Eigen::SparseMatrix<double>& lower, std::span<const int> block_starts) {
    Eigen::SparseMatrix<double> pattern = block_pattern(lower, block_starts);
    cholmod_sparse block_view = view_of(pattern);
    std::vector<int> block_order(static_cast<std::size_t>(pattern.cols()));
    if (!cholmod_amd(&block_view, nullptr, 0, block_order.data(), &common)) return false;
    std::vector<int> order;
    order.reserve(static_cast<std::size_t>(lower.cols()));
    for (const int block : block_order) {
      const auto b = static_cast<std::size_t>(block);
      for (int i = block_starts[b]; i < block_starts[b + 1]; ++i) order.push_back(i);
    }
    common.method[0].ordering = CHOLMOD_GIVEN;
    cholmod_free_factor(&factor, &common);
    cholmod_sparse view = view_of(lower);
    factor = cholmod_analyze_p(&view, order.data(), nullptr, 0, &common);
    outer.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1);
    inner.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
    ++num_analyses;
    return factor != nullptr;
  }
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

CholeskyStatus SparseCholesky::factorize(const Eigen::SparseMatrix<double>& lower,
                                         std::span<const int> block_starts) {
  CORRIDOR_EXPECT(lower.isCompressed() && lower.rows() == lower.cols() && lower.rows() > 0);
  CORRIDOR_EXPECT(block_starts.size() >= 2 && block_starts.back() == lower.rows());
  impl_->first_bad_column = -1;
  if (!impl_->has_pattern_of(lower) && !impl_->analyze(lower, block_starts)) {
    return CholeskyStatus::kOutOfMemory;
  }
  cholmod_sparse view = view_of(lower);
  cholmod_factorize(&view, impl_->factor, &impl_->common);
  if (impl_->common.status == CHOLMOD_OUT_OF_MEMORY) return CholeskyStatus::kOutOfMemory;
  const cholmod_factor& factor = *impl_->factor;
  if (impl_->common.status == CHOLMOD_NOT_POSDEF || factor.minor < factor.n) {
    const auto minor = std::min(factor.minor, factor.n - 1);
    impl_->first_bad_column = static_cast<const int*>(factor.Perm)[minor];
    return CholeskyStatus::kNotPositiveDefinite;
  }
  if (!(cholmod_rcond(impl_->factor, &impl_->common) > kMinReciprocalCondition)) {
    return CholeskyStatus::kNotPositiveDefinite;
  }
  return CholeskyStatus::kOk;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const {
  CORRIDOR_EXPECT(impl_->factor != nullptr &&
                  static_cast<std::size_t>(b.rows()) == impl_->factor->n);
  Eigen::MatrixXd right_hand_side = b;
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(b.rows());
  view.ncol = static_cast<std::size_t>(b.cols());
  view.nzmax = view.nrow * view.ncol;
  view.d = view.nrow;
  view.x = right_hand_side.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, impl_->factor, &view, &impl_->common);
  CORRIDOR_ENSURE(x != nullptr);
  std::memcpy(right_hand_side.data(), x->x, sizeof(double) * view.nzmax);
  cholmod_free_dense(&x, &impl_->common);
  return right_hand_side;
}

int SparseCholesky::first_bad_column() const { return impl_->first_bad_column; }
double SparseCholesky::num_factor_nonzeros() const { return impl_->common.lnz; }
int SparseCholesky::num_analyses() const { return impl_->num_analyses; }

}  // namespace corridor::linear
