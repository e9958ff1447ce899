// Dense kernels of a multifrontal Cholesky factorisation [Duff1983]: fronts of a few to a few
// hundred rows, for which a BLAS call costs more than the work. Portable vector code, one thread.
#pragma once

#include <cstddef>

namespace corridor::linear {

// Rows that a kernel may touch beyond the last of a column: columns lie front_stride() apart and
// hold finite numbers up to there.
constexpr int kFrontPadding = 7;

// Distance of the columns of a matrix with `num_rows` rows.
constexpr std::ptrdiff_t front_stride(int num_rows) {
  return (num_rows + kFrontPadding + 3) / 4 * 4;
}

// Factorises the first `num_pivots` columns of a symmetric positive definite front, of which
// `panel` holds the lower part: num_rows x num_pivots, column-major with `stride`. Afterwards it
// holds [L11; L21]; what was above the diagonal is left alone. A pivot that falls to `min_ratio` of
// the diagonal entry that the panel held or below ends it. Returns the number of pivots done:
// num_pivots, or the column at which it broke down.
int factorize_panel(double* panel, std::ptrdiff_t stride, int num_rows, int num_pivots,
                    const double* min_pivots);

// update -= L21 L21^T on the lower triangle, where L21 are rows num_pivots ... num_rows - 1 of a
// factorised panel. update: square, num_rows - num_pivots rows, column-major with `update_stride`.
void subtract_outer_product(const double* panel, std::ptrdiff_t stride, int num_rows,
                            int num_pivots, double* update, std::ptrdiff_t update_stride);

}  // namespace corridor::linear
