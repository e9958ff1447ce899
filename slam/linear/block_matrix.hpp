// A symmetric matrix of dense blocks, one per pair of variables that share a factor: the lower
// triangle of the normal equations.
// The blocks lie so that they are a compressed-column (CSC) matrix of scalars at the same time:
// all scalar columns of a variable hold the same rows, its diagonal block in full (both triangles,
// of which readers use the lower one). A solver reads that storage without any conversion.
//
// Structure and values: slots keep their numbers for ever. add_variable() and a slot() that is new
// make the values void; the next set_zero() gives every block its place and clears it. Without a
// change of structure set_zero() allocates nothing.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "slam/core/expect.hpp"
#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

class BlockMatrix {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;
  using Scalars = Eigen::Map<const Eigen::SparseMatrix<double>>;

  // Adds a variable of that many rows; returns its index, counted from 0.
  int add_variable(int dimension);
  // Number of the block of rows `row_variable` and columns `column_variable` in the lower triangle
  // (row_variable >= column_variable), made if it is new.
  std::size_t slot(int row_variable, int column_variable);
  [[nodiscard]] int num_variables() const { return static_cast<int>(columns_.size()); }
  [[nodiscard]] int num_rows() const { return starts_.back(); }
  // First scalar row of every variable, and the number of rows at the end.
  [[nodiscard]] const std::vector<int>& starts() const { return starts_; }

  void set_zero();

  // What follows requires a set_zero() after the last change of structure.

  // dimension(row variable) x dimension(column variable); valid until the structure changes.
  [[nodiscard]] Block block(std::size_t slot) {
    const Place& place = place_of(slot);
    return {values_.data() + place.offset, place.num_rows, place.num_columns,
            Eigen::OuterStride<>(place.stride)};
  }
  [[nodiscard]] ConstBlock block(std::size_t slot) const {
    const Place& place = place_of(slot);
    return {values_.data() + place.offset, place.num_rows, place.num_columns,
            Eigen::OuterStride<>(place.stride)};
  }
  // Adds an expression of the block's size; the loops are unrolled if that size is constant.
  template <class Derived>
  void add(std::size_t slot, const Eigen::MatrixBase<Derived>& summand) {
    using Plain = typename Derived::PlainObject;
    const Place& place = place_of(slot);
    CORRIDOR_EXPECT(summand.rows() == place.num_rows && summand.cols() == place.num_columns);
    // A row of constant size is row-major to Eigen: its entries are a stride apart.
    using Stride =
        std::conditional_t<Plain::IsRowMajor, Eigen::InnerStride<>, Eigen::OuterStride<>>;
    static_assert(!Plain::IsRowMajor || Plain::RowsAtCompileTime == 1);
    Eigen::Map<Plain, Eigen::Unaligned, Stride>(values_.data() + place.offset, place.num_rows,
                                                place.num_columns, Stride(place.stride))
        .noalias() += summand;
  }

  [[nodiscard]] const BlockPattern& pattern() const;  // rows ascending
  // The lower triangle as scalars, with the diagonal blocks in full: compressed, rows ascending.
  [[nodiscard]] Scalars scalars() const;

 private:
  struct Entry {
    int row_variable;
    std::size_t slot;
  };
  struct Place {
    std::ptrdiff_t offset = 0;  // of the block's first entry among the values
    int stride = 0;             // from one of its columns to the next
    int num_rows = 0, num_columns = 0;
  };

  [[nodiscard]] const Place& place_of(std::size_t slot) const {
    CORRIDOR_EXPECT(is_laid_out_);
    return places_[slot];
  }
  [[nodiscard]] int dimension(int variable) const;
  void lay_out();
  void lay_out_column(int variable);

  std::vector<std::vector<Entry>> columns_;  // per column variable, ascending row variables
  std::vector<int> starts_ = {0};
  std::vector<Place> places_;  // by slot
  BlockPattern pattern_;
  std::vector<int> outer_starts_, inner_rows_;  // of the scalars
  std::vector<double> values_;
  bool is_laid_out_ = false;
};

}  // namespace corridor::linear
