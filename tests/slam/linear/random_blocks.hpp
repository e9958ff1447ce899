// Random symmetric block matrices for tests: variables of 1 to 5 rows in the shapes that graphs of
// SLAM have, and in some that they should not have.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/linear/block_matrix.hpp"

namespace corridor::linear {

using Pair = std::pair<int, int>;  // variables, the higher one first

inline int below(Rng& rng, int bound) {
  return static_cast<int>(rng.below(static_cast<std::uint64_t>(bound)));
}

// A chain, a grid, all pairs, or several chains that know nothing of each other; with some random
// pairs more.
inline std::vector<Pair> random_pairs(Rng& rng, int num_variables) {
  std::vector<Pair> pairs;
  const int shape = below(rng, 4);
  const int width = 2 + below(rng, 5);
  for (int i = 1; i < num_variables; ++i) {
    for (int j = 0; j < i; ++j) {
      const bool is_in_shape = shape == 0   ? i == j + 1
                               : shape == 1 ? i == j + 1 || i == j + width
                               : shape == 2 ? true
                                            : i == j + 1 && i % width != 0;
      const bool is_extra = shape < 3 && rng.uniform() < 1.0 / num_variables;
      if (is_in_shape || is_extra) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

inline std::vector<int> random_dimensions(Rng& rng, int num_variables) {
  std::vector<int> dimensions;
  for (int v = 0; v < num_variables; ++v) dimensions.push_back(1 + below(rng, 5));
  return dimensions;
}

inline Eigen::MatrixXd random_matrix(Rng& rng, Eigen::Index num_rows, Eigen::Index num_columns) {
  Eigen::MatrixXd matrix(num_rows, num_columns);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix(i) = rng.normal();
  return matrix;
}

// The structure, with zeros for values. Slots are made in a random order of the pairs.
inline BlockMatrix make_structure(Rng& rng, const std::vector<int>& dimensions,
                                  std::vector<Pair> pairs) {
  BlockMatrix matrix;
  for (const int dimension : dimensions) matrix.add_variable(dimension);
  for (std::size_t k = pairs.size(); k > 1; --k) {
    std::swap(pairs[k - 1], pairs[static_cast<std::size_t>(below(rng, static_cast<int>(k)))]);
  }
  for (const auto& [i, j] : pairs) matrix.slot(i, j);
  matrix.set_zero();
  return matrix;
}

// Sum of J^T J over the pairs, whose J have random entries, and the identity times `prior`.
inline void fill_positive(Rng& rng, const std::vector<Pair>& pairs, double prior,
                          BlockMatrix& matrix) {
  matrix.set_zero();
  for (int v = 0; v < matrix.num_variables(); ++v) {
    matrix.block(matrix.slot(v, v)).diagonal().array() += prior;
  }
  for (const auto& [i, j] : pairs) {
    auto block = matrix.block(matrix.slot(i, j));
    const Eigen::MatrixXd J_i = random_matrix(rng, 3, block.rows());
    const Eigen::MatrixXd J_j = random_matrix(rng, 3, block.cols());
    block += J_i.transpose() * J_j;
    matrix.add(matrix.slot(i, i), J_i.transpose() * J_i);
    matrix.add(matrix.slot(j, j), J_j.transpose() * J_j);
  }
}

inline BlockMatrix random_positive_matrix(Rng& rng) {
  const int num_variables = 1 + below(rng, 40);
  const std::vector<Pair> pairs = random_pairs(rng, num_variables);
  BlockMatrix matrix = make_structure(rng, random_dimensions(rng, num_variables), pairs);
  fill_positive(rng, pairs, 1.0, matrix);
  return matrix;
}

inline Eigen::MatrixXd to_dense(const BlockMatrix& matrix) {
  return Eigen::MatrixXd(matrix.scalars()).selfadjointView<Eigen::Lower>();
}

}  // namespace corridor::linear
