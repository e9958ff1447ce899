// Where everything lies in a multifrontal factorisation: the scalar rows of every front, the blocks
// of the matrix that it takes, and how its update enters its parent's front. From the pattern
// alone.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/linear/block_matrix.hpp"
#include "slam/linear/supernodes.hpp"

namespace corridor::linear {

// Scalar rows that are consecutive here and there.
struct RowRun {
  int from = 0, to = 0, length = 0;
};

// A block of the matrix and its place in the panels, transposed if the order of elimination turns
// its variables round: entry (r, c) at to + r * row_step + c * column_step.
struct BlockCopy {
  std::ptrdiff_t from = 0;  // among the matrix's values
  std::ptrdiff_t to = 0;    // among those of all panels
  int from_stride = 0;
  int row_step = 0, column_step = 0;
  int num_rows = 0, num_columns = 0;
};

// One supernode: a panel of num_rows x num_pivots, column-major, and an update of
// num_rows - num_pivots rows and columns that goes to its parent.
struct Front {
  int num_pivots = 0, num_rows = 0;
  int first_pivot = 0;        // scalar row in the order of elimination
  std::ptrdiff_t stride = 0;  // of the panel's columns
  std::ptrdiff_t panel = 0;   // offset of the panel among all
  int num_children = 0;
  bool has_parent = false;
  std::size_t first_copy = 0, end_copy = 0;  // of copies
  std::size_t first_run = 0, end_run = 0;    // of runs: rows below the pivots to the solution
  std::size_t first_join = 0, end_join = 0;  // of joins: rows of the update to the parent's rows

  [[nodiscard]] int num_below() const { return num_rows - num_pivots; }
  [[nodiscard]] std::ptrdiff_t panel_size() const { return num_pivots * stride; }
  [[nodiscard]] std::ptrdiff_t update_stride() const;
  [[nodiscard]] std::ptrdiff_t update_size() const { return num_below() * update_stride(); }
};

struct FrontLayout {
  EliminationPlan plan;
  std::vector<int> row_order;  // scalar row of the matrix at every place
  std::vector<Front> fronts;   // children before parents
  std::vector<BlockCopy> copies;
  std::vector<RowRun> runs, joins;
  std::ptrdiff_t panels_size = 0;  // doubles of all panels
  std::ptrdiff_t stack_size = 0;   // doubles of the updates that wait at the same time, at most
  int max_rows = 0;                // of a front
  double num_nonzeros = 0;         // of L, the zeros that supernodes fill included
  double num_flops = 0;            // multiplications and additions of a factorisation
};

// order: of elimination, the variable at every place.
FrontLayout lay_out_fronts(const BlockMatrix& matrix, const std::vector<int>& order);

}  // namespace corridor::linear
