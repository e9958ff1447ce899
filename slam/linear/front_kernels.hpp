// Dense kernels of a multifrontal Cholesky factorisation [Duff1983]: fronts of a few to a few
// hundred rows, for which a BLAS call costs more than the work. Portable vector code, one thread.
//
// A front's panel holds its columns of L, [L11; L21], with the diagonal inverted (substitution
// would wait for the divisions): num_rows x num_pivots, column-major, the columns front_stride()
// apart. Kernels read and write whole vectors, up to kFrontPadding numbers
// beyond the last row: there panels hold zeros.
#pragma once

#include <cstddef>

namespace corridor::linear {

constexpr int kFrontPadding = 7;  // a vector of 8 that begins at the last row

// Distance of the columns of a matrix with `num_rows` rows: room for the padding, and a multiple
// of 4 numbers so that columns begin at a 32-byte step of each other.
constexpr std::ptrdiff_t front_stride(int num_rows) {
  return (num_rows + kFrontPadding + 3) / 4 * 4;
}

// Turns the first `num_pivots` columns of a symmetric front, of which `panel` holds the lower part,
// into [L11; L21]. What lies above the diagonal is neither used nor meant afterwards. Returns the
// number of pivots done: num_pivots, or the column whose pivot is not positive.
int factorize_panel(double* panel, std::ptrdiff_t stride, int num_rows, int num_pivots);

// update -= L21 L21^T on the lower triangle. update: square, num_rows - num_pivots rows,
// column-major, `update_stride` apart.
void subtract_outer_product(const double* panel, std::ptrdiff_t stride, int num_rows,
                            int num_pivots, double* update, std::ptrdiff_t update_stride);

// x has num_rows numbers and its padding, (x1, x2) as the panel's rows.
// x1 := L11^-1 x1, then x2 -= L21 x1.
void solve_panel(const double* panel, std::ptrdiff_t stride, int num_rows, int num_pivots,
                 double* x);
// x1 := L11^-T (x1 - L21^T x2).
void solve_transposed_panel(const double* panel, std::ptrdiff_t stride, int num_rows,
                            int num_pivots, double* x);

}  // namespace corridor::linear
