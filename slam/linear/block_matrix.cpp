#include "slam/linear/block_matrix.hpp"

#include <algorithm>
#include <limits>

namespace corridor::linear {

int BlockMatrix::add_variable(int dimension) {
  CORRIDOR_EXPECT(dimension > 0);
  columns_.emplace_back();
  starts_.push_back(starts_.back() + dimension);
  const int index = num_variables() - 1;
  slot(index, index);
  return index;
}

int BlockMatrix::dimension(int variable) const {
  const auto index = to_index(variable);
  return starts_[index + 1] - starts_[index];
}

std::size_t BlockMatrix::slot(int row_variable, int column_variable) {
  CORRIDOR_EXPECT(0 <= column_variable && column_variable <= row_variable &&
                  row_variable < num_variables());
  auto& column = columns_[to_index(column_variable)];
  const auto place =
      std::lower_bound(column.begin(), column.end(), row_variable,
                       [](const Entry& entry, int row) { return entry.row_variable < row; });
  if (place != column.end() && place->row_variable == row_variable) return place->slot;
  is_laid_out_ = false;
  places_.push_back({0, 0, dimension(row_variable), dimension(column_variable)});
  column.insert(place, Entry{row_variable, places_.size() - 1});
  return places_.size() - 1;
}

void BlockMatrix::set_zero() {
  if (!is_laid_out_) lay_out();
  std::fill(values_.begin(), values_.end(), 0.0);
}

void BlockMatrix::lay_out() {
  pattern_.starts.assign(1, 0);
  pattern_.rows.clear();
  outer_starts_.assign(1, 0);
  inner_rows_.clear();
  for (int j = 0; j < num_variables(); ++j) lay_out_column(j);
  values_.resize(inner_rows_.size());
  is_laid_out_ = true;
}

void BlockMatrix::lay_out_column(int variable) {
  const std::vector<Entry>& column = columns_[to_index(variable)];
  const std::size_t begin = inner_rows_.size();
  for (const Entry& entry : column) {
    if (entry.row_variable != variable) pattern_.rows.push_back(entry.row_variable);
    places_[entry.slot].offset = static_cast<std::ptrdiff_t>(inner_rows_.size());
    const int first_row = starts_[to_index(entry.row_variable)];
    for (int r = 0; r < dimension(entry.row_variable); ++r) inner_rows_.push_back(first_row + r);
  }
  pattern_.starts.push_back(static_cast<int>(pattern_.rows.size()));
  const std::size_t height = inner_rows_.size() - begin;
  for (const Entry& entry : column) places_[entry.slot].stride = static_cast<int>(height);
  // The variable's other columns hold the same rows.
  const std::size_t num_columns = to_index(dimension(variable));
  CORRIDOR_EXPECT(begin + num_columns * height <= std::numeric_limits<int>::max());
  inner_rows_.resize(begin + num_columns * height);
  for (std::size_t c = 0; c < num_columns; ++c) {
    if (c > 0) std::copy_n(&inner_rows_[begin], height, &inner_rows_[begin + c * height]);
    outer_starts_.push_back(static_cast<int>(begin + (c + 1) * height));
  }
}

const BlockPattern& BlockMatrix::pattern() const {
  CORRIDOR_EXPECT(is_laid_out_);
  return pattern_;
}

BlockMatrix::Scalars BlockMatrix::scalars() const {
  CORRIDOR_EXPECT(is_laid_out_);
  return {num_rows(),           num_rows(),         static_cast<Eigen::Index>(values_.size()),
          outer_starts_.data(), inner_rows_.data(), values_.data()};
}

}  // namespace corridor::linear
