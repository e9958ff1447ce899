// One term of the least-squares problem: min over X of sum_i rho_i(|| r_i(X_i) ||^2).
//
// A type of factor is a plain class, known to the compiler with its dimensions: the graph keeps
// factors of one type side by side, and solvers run over them without virtual calls or allocation.
//
//   static constexpr std::string_view kName;               "relative_pose"
//   static constexpr int kRows;                            of the residual
//   static constexpr std::array<VariableKind, N> kKinds;   of its variables, in the order of keys()
//   const std::array<Key, N>& keys() const;
//   void linearize(const Values&, Residual<F>& r, Jacobian<F>& J) const;
//   void residual(const Values&, Residual<F>& r) const;    the same r alone
//
// Residuals are whitened: r = U e with U^T U = Omega the information matrix, so that chi2 = ||r||^2
// (g2o's convention, no factor 1/2). Jacobians are with respect to the right tangent of each
// variable (Values::retract), side by side in the order of keys(). Every factor type of the suite
// is listed in any_factor.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "slam/graph/key.hpp"
#include "slam/graph/values.hpp"

namespace corridor::graph {

// A type whose number of variables is known only at run time has kRows = Eigen::Dynamic, no kKinds,
// num_rows(), and keys() as a vector.
template <class F>
inline constexpr bool kIsFixed = F::kRows != Eigen::Dynamic;

// Of a type that says kIsLinear = true the Jacobian is the same everywhere.
template <class F>
inline constexpr bool kIsLinear = requires {
  requires F::kIsLinear;
};

template <class F>
inline constexpr std::size_t kNumKeys = F::kKinds.size();

// Columns of the Jacobian before those of the key-th variable; of all of them for key = kNumKeys.
template <class F>
constexpr int first_column(std::size_t key) {
  int columns = 0;
  for (std::size_t k = 0; k < key; ++k) columns += dimension_of(F::kKinds[k]);
  return columns;
}

template <class F>
consteval int num_columns() {
  if constexpr (kIsFixed<F>) return first_column<F>(kNumKeys<F>);
  return Eigen::Dynamic;
}

// Of a class that is being defined these cannot be asked: FixedVector and FixedMatrix say the same.
template <int kRows>
using FixedVector = Eigen::Matrix<double, kRows, 1>;
template <int kRows, int kColumns>
using FixedMatrix = Eigen::Matrix<double, kRows, kColumns>;

template <class F>
using Residual = FixedVector<F::kRows>;
template <class F>
using Jacobian = FixedMatrix<F::kRows, num_columns<F>()>;

template <class F>
int num_rows(const F& factor) {
  if constexpr (kIsFixed<F>)
    return F::kRows;
  else
    return factor.num_rows();
}

template <class F>
double chi2_of(const F& factor, const Values& values) {
  Residual<F> r;
  factor.residual(values, r);
  return r.squaredNorm();
}

}  // namespace corridor::graph
