// The normal equations' matrix as dense blocks, one per pair of variables that share a factor.
// Built once as variables and pairs arrive; its values are cleared and summed up anew at every
// linearisation, without allocation while the structure stays.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

namespace corridor::linear {

class BlockMatrix {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd>;

  // Adds a variable of that many rows; returns its index, counted from 0.
  int add_variable(int dimension);
  // Number of the block of rows `row_variable` and columns `column_variable` in the lower triangle
  // (row_variable >= column_variable), made if it is new.
  std::size_t slot(int row_variable, int column_variable);

  void set_zero();
  // dimension(row variable) x dimension(column variable); valid until the next slot() or
  // add_variable().
  [[nodiscard]] Block block(std::size_t slot);
  // The same with its size known beforehand.
  template <int kRows, int kColumns>
  [[nodiscard]] Eigen::Map<Eigen::Matrix<double, kRows, kColumns>> block(std::size_t slot) {
    return Eigen::Map<Eigen::Matrix<double, kRows, kColumns>>(values_.data() +
                                                              slots_[slot].offset);
  }

  [[nodiscard]] int num_variables() const { return static_cast<int>(columns_.size()); }
  [[nodiscard]] int num_rows() const { return starts_.back(); }
  // First scalar row of every variable, and the number of rows at the end.
  [[nodiscard]] const std::vector<int>& starts() const { return starts_; }

  // Writes the scalar lower triangle, compressed and sorted.
  void write_lower(Eigen::SparseMatrix<double>& lower) const;

 private:
  struct Entry {
    int row_variable;
    std::size_t slot;
  };
  struct Slot {
    std::size_t offset;
    int num_rows, num_columns;
  };

  std::vector<std::vector<Entry>> columns_;  // per column variable, ascending row variables
  std::vector<Slot> slots_;
  std::vector<double> values_;
  std::vector<int> starts_ = {0};
};

}  // namespace corridor::linear
