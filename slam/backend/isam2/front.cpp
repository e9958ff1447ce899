#include "slam/backend/isam2/front.hpp"

#include <cstring>

namespace corridor::backend {
using linear::to_index;

namespace {

using linear::front_stride;

// A pivot below this share of what factors added to its diagonal entry has no correct digit left:
// rounding alone leaves up to 1e-15 (graphs that nothing holds), a graph that is determined no less
// than 2e-13 (intel1228, with information up to 1e12).
constexpr double kMinPivotRatio = 1e-14;

std::ptrdiff_t panel_size(int num_pivots, int num_below) {
  return num_pivots * front_stride(num_pivots + num_below + 1);
}

std::ptrdiff_t update_size(int num_below) { return (num_below + 1) * front_stride(num_below + 1); }

}  // namespace

std::size_t Front::memory_size(int num_pivots, int num_below) {
  return to_index(panel_size(num_pivots, num_below) + update_size(num_below) + num_pivots +
                  num_below + 1);
}

Front::Front(double* memory, int num_pivots, int num_below)
    : panel_(memory),
      update_(panel_ + panel_size(num_pivots, num_below)),
      scale_(update_ + update_size(num_below)),
      num_pivots_(num_pivots),
      num_below_(num_below),
      stride_(front_stride(num_pivots + num_below + 1)),
      update_stride_(front_stride(num_below + 1)) {}

void Front::set_zero() {
  std::memset(panel_, 0, sizeof(double) * memory_size(num_pivots_, num_below_));
}

void Front::add_update(const Front& child, std::span<const RowRun> runs) {
  const int child_pivots = child.num_pivots();
  for (std::size_t j = 0; j < runs.size(); ++j) {
    const RowRun& columns = runs[j];
    for (int c = 0; c < columns.length; ++c) {
      const double* const from =
          child.update_column(child_pivots + columns.from + c) + child_pivots;
      const int column = columns.to + c;
      scale_[column] += child.scale_[child_pivots + columns.from + c];
      double* const to = column_of(column);
      for (int r = c; r < columns.length; ++r) to[columns.to + r] += from[columns.from + r];
      for (std::size_t i = j + 1; i < runs.size(); ++i) {
        const RowRun& rows = runs[i];
        if (rows.to > columns.to) {
          for (int r = 0; r < rows.length; ++r) to[rows.to + r] += from[rows.from + r];
        } else {  // the parent eliminates them the other way round
          for (int r = 0; r < rows.length; ++r) {
            column_of(rows.to + r)[column] += from[rows.from + r];
          }
        }
      }
    }
  }
}

int Front::eliminate() {
  int num_good = linear::factorize_panel(panel_, stride_, last_row() + 1, num_pivots_);
  for (int k = 0; k < num_good; ++k) {
    const double inverse = panel_[k * stride_ + k];  // of the square root of the pivot
    if (!(1 > kMinPivotRatio * scale_[k] * inverse * inverse)) num_good = k;
  }
  if (num_good == num_pivots_) {
    linear::subtract_outer_product(panel_, stride_, last_row() + 1, num_pivots_, update_,
                                   update_stride_);
  }
  return num_good;
}

}  // namespace corridor::backend
