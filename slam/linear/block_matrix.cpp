#include "slam/linear/block_matrix.hpp"

#include <algorithm>

#include "slam/core/expect.hpp"

namespace corridor::linear {

int BlockMatrix::add_variable(int dimension) {
  CORRIDOR_EXPECT(dimension > 0);
  columns_.emplace_back();
  starts_.push_back(starts_.back() + dimension);
  const int index = num_variables() - 1;
  slot(index, index);
  return index;
}

std::size_t BlockMatrix::slot(int row_variable, int column_variable) {
  CORRIDOR_EXPECT(0 <= column_variable && column_variable <= row_variable &&
                  row_variable < num_variables());
  auto& column = columns_[static_cast<std::size_t>(column_variable)];
  const auto place =
      std::lower_bound(column.begin(), column.end(), row_variable,
                       [](const Entry& entry, int row) { return entry.row_variable < row; });
  if (place != column.end() && place->row_variable == row_variable) return place->slot;
  const auto rows = static_cast<std::size_t>(row_variable);
  const auto cols = static_cast<std::size_t>(column_variable);
  const Slot made{values_.size(), starts_[rows + 1] - starts_[rows],
                  starts_[cols + 1] - starts_[cols]};
  values_.resize(values_.size() + static_cast<std::size_t>(made.num_rows * made.num_columns));
  slots_.push_back(made);
  column.insert(place, Entry{row_variable, slots_.size() - 1});
  return slots_.size() - 1;
}

void BlockMatrix::set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

BlockMatrix::Block BlockMatrix::block(std::size_t slot) {
  const Slot& s = slots_[slot];
  return {values_.data() + s.offset, s.num_rows, s.num_columns};
}

void BlockMatrix::write_lower(Eigen::SparseMatrix<double>& lower) const {
  lower.resize(num_rows(), num_rows());
  Eigen::Index num_entries = 0;
  for (const Slot& s : slots_) num_entries += s.num_rows * s.num_columns;
  lower.reserve(num_entries);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    for (int c = 0; c < starts_[j + 1] - starts_[j]; ++c) {
      const int scalar_column = starts_[j] + c;
      lower.startVec(scalar_column);
      for (const Entry& entry : columns_[j]) {
        const Slot& s = slots_[entry.slot];
        const bool is_diagonal = entry.row_variable == static_cast<int>(j);
        const double* values = values_.data() + s.offset + c * s.num_rows;
        const int first_row = starts_[static_cast<std::size_t>(entry.row_variable)];
        for (int r = is_diagonal ? c : 0; r < s.num_rows; ++r) {
          lower.insertBackByOuterInnerUnordered(scalar_column, first_row + r) = values[r];
        }
      }
    }
  }
  lower.finalize();
}

}  // namespace corridor::linear
