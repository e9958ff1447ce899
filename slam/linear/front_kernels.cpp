#include "slam/linear/front_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace corridor::linear {
namespace {

// Numbers that the machine works on at a time; eight with the preset "native" only.
#if defined(__AVX512F__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
static_assert(kLanes - 1 <= kFrontPadding);
using Lanes __attribute__((vector_size(8 * kLanes))) = double;
using LooseLanes __attribute__((vector_size(8 * kLanes), aligned(8), may_alias)) = double;

// Columns that are worked on at a time: with two rows of lanes they fill the registers.
constexpr int kMaxWidth = 6;

Lanes load(const double* at) { return *reinterpret_cast<const LooseLanes*>(at); }
void store(double* at, Lanes values) { *reinterpret_cast<LooseLanes*>(at) = values; }

// kHeight x kLanes rows of C -= A B^T, then C := C L^-T where `corner` is L (kWidth x kWidth with
// its diagonal inverted), if there is one. A has `depth` columns, as B.
template <int kWidth, int kHeight>
void update_rows(double* c, std::ptrdiff_t c_stride, const double* a, const double* b,
                 std::ptrdiff_t stride, int depth, const double* corner) {
  Lanes sum[kHeight][kWidth];
  for (int h = 0; h < kHeight; ++h) {
    for (int w = 0; w < kWidth; ++w) sum[h][w] = load(c + w * c_stride + h * kLanes);
  }
  for (int k = 0; k < depth; ++k) {
    Lanes rows[kHeight];
    for (int h = 0; h < kHeight; ++h) rows[h] = load(a + k * stride + h * kLanes);
    for (int w = 0; w < kWidth; ++w) {
      const double factor = b[k * stride + w];
      for (int h = 0; h < kHeight; ++h) sum[h][w] -= rows[h] * factor;
    }
  }
  if (corner != nullptr) {
    for (int w = 0; w < kWidth; ++w) {
      for (int k = 0; k < w; ++k) {
        for (int h = 0; h < kHeight; ++h) sum[h][w] -= sum[h][k] * corner[k * kMaxWidth + w];
      }
      for (int h = 0; h < kHeight; ++h) sum[h][w] *= corner[w * kMaxWidth + w];
    }
  }
  for (int h = 0; h < kHeight; ++h) {
    for (int w = 0; w < kWidth; ++w) store(c + w * c_stride + h * kLanes, sum[h][w]);
  }
}

template <int kWidth>
void update_columns(double* c, std::ptrdiff_t c_stride, const double* a, const double* b,
                    std::ptrdiff_t stride, int num_rows, int depth, const double* corner) {
  int row = 0;
  for (; row + kLanes < num_rows; row += 2 * kLanes) {
    update_rows<kWidth, 2>(c + row, c_stride, a + row, b, stride, depth, corner);
  }
  if (row < num_rows) {
    update_rows<kWidth, 1>(c + row, c_stride, a + row, b, stride, depth, corner);
  }
}

// Calls `work` with the width as a constant.
template <class Work>
decltype(auto) with_width(int width, const Work& work) {
  static_assert(kMaxWidth == 6);
  if (width == 1) return work(std::integral_constant<int, 1>());
  if (width == 2) return work(std::integral_constant<int, 2>());
  if (width == 3) return work(std::integral_constant<int, 3>());
  if (width == 4) return work(std::integral_constant<int, 4>());
  if (width == 5) return work(std::integral_constant<int, 5>());
  return work(std::integral_constant<int, 6>());
}

// The square at the top of `kWidth` columns: takes off what the `depth` columns to its left (whose
// rows begin at `left`) say, and factorises it. `corner` gets its factor with inverted diagonal.
// Returns the number of good pivots.
template <int kWidth>
int factorize_corner(double* top, const double* left, std::ptrdiff_t stride, int depth,
                     double* corner) {
  double square[kWidth][kWidth];  // by columns
  for (int w = 0; w < kWidth; ++w) {
    for (int r = 0; r < kWidth; ++r) square[w][r] = top[w * stride + r];
  }
  for (int k = 0; k < depth; ++k) {
    const double* column = left + k * stride;
    for (int w = 0; w < kWidth; ++w) {
      for (int r = 0; r < kWidth; ++r) square[w][r] -= column[r] * column[w];
    }
  }
  for (int w = 0; w < kWidth; ++w) {
    for (int k = 0; k < w; ++k) {
      for (int r = w; r < kWidth; ++r) square[w][r] -= square[k][r] * square[k][w];
    }
    if (!(square[w][w] > 0)) return w;
    const double inverse = 1 / std::sqrt(square[w][w]);
    for (int r = w; r < kWidth; ++r) {
      square[w][r] *= inverse;
      top[w * stride + r] = corner[w * kMaxWidth + r] = square[w][r];
    }
    top[w * stride + w] = corner[w * kMaxWidth + w] = inverse;
  }
  return kWidth;
}

// x1 := L11^-1 x1 for the kWidth columns whose square begins at `top`, then takes them off what is
// below.
template <int kWidth>
void solve_columns(const double* top, std::ptrdiff_t stride, int num_rows, double* x) {
  for (int w = 0; w < kWidth; ++w) {
    for (int k = 0; k < w; ++k) x[w] -= top[k * stride + w] * x[k];
    x[w] *= top[w * stride + w];
  }
  for (int row = kWidth; row < num_rows; row += kLanes) {
    Lanes sum = load(x + row);
    for (int w = 0; w < kWidth; ++w) sum -= load(top + w * stride + row) * x[w];
    store(x + row, sum);
  }
}

// x1 := L11^-T (x1 - L21^T x2) for such columns.
template <int kWidth>
void solve_transposed_columns(const double* top, std::ptrdiff_t stride, int num_rows, double* x) {
  Lanes sums[kWidth] = {};
  for (int row = kWidth; row < num_rows; row += kLanes) {
    const Lanes rows = load(x + row);
    for (int w = 0; w < kWidth; ++w) sums[w] += load(top + w * stride + row) * rows;
  }
  for (int w = kWidth; w-- > 0;) {
    for (int lane = 0; lane < kLanes; ++lane) x[w] -= sums[w][lane];
    for (int k = w + 1; k < kWidth; ++k) x[w] -= top[w * stride + k] * x[k];
    x[w] *= top[w * stride + w];
  }
}

}  // namespace

int factorize_panel(double* panel, std::ptrdiff_t stride, int num_rows, int num_pivots) {
  double corner[kMaxWidth * kMaxWidth];
  for (int first = 0; first < num_pivots; first += kMaxWidth) {
    const int width = std::min(kMaxWidth, num_pivots - first);
    const int num_good = with_width(width, [&](auto constant) {
      constexpr int kWidth = decltype(constant)::value;
      double* top = panel + first * stride + first;
      const double* left = panel + first;
      const int good = factorize_corner<kWidth>(top, left, stride, first, corner);
      if (good == kWidth) {
        update_columns<kWidth>(top + kWidth, stride, left + kWidth, left, stride,
                               num_rows - first - kWidth, first, corner);
      }
      return good;
    });
    if (num_good < width) return first + num_good;
  }
  return num_pivots;
}

void subtract_outer_product(const double* panel, std::ptrdiff_t stride, int num_rows,
                            int num_pivots, double* update, std::ptrdiff_t update_stride) {
  const int num_columns = num_rows - num_pivots;
  const double* rows = panel + num_pivots;
  for (int first = 0; first < num_columns; first += kMaxWidth) {
    with_width(std::min(kMaxWidth, num_columns - first), [&](auto constant) {
      update_columns<decltype(constant)::value>(update + first * update_stride + first,
                                                update_stride, rows + first, rows + first, stride,
                                                num_columns - first, num_pivots, nullptr);
    });
  }
}

void solve_panel(const double* panel, std::ptrdiff_t stride, int num_rows, int num_pivots,
                 double* x) {
  for (int first = 0; first < num_pivots; first += kMaxWidth) {
    with_width(std::min(kMaxWidth, num_pivots - first), [&](auto constant) {
      solve_columns<decltype(constant)::value>(panel + first * stride + first, stride,
                                               num_rows - first, x + first);
    });
  }
}

void solve_transposed_panel(const double* panel, std::ptrdiff_t stride, int num_rows,
                            int num_pivots, double* x) {
  for (int end = num_pivots; end > 0;) {
    const int width = std::min(kMaxWidth, end);
    end -= width;
    with_width(width, [&](auto constant) {
      solve_transposed_columns<decltype(constant)::value>(panel + end * stride + end, stride,
                                                          num_rows - end, x + end);
    });
  }
}

}  // namespace corridor::linear
