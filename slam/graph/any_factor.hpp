// The factor types of the suite. A new one is written like its neighbours in factors/ and added to
// this list: graph, solvers and tests take it from here.
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "slam/graph/factors/gaussian_prior.hpp"
#include "slam/graph/factors/motion_factors.hpp"
#include "slam/graph/factors/pose_factors.hpp"
#include "slam/graph/factors/vector_prior.hpp"
#include "slam/graph/robust_kernel.hpp"

namespace corridor::graph {

using AnyFactor =
    std::variant<PosePrior, RelativePose, ImuMotion, WheelMotion, BiasWalk, WheelCalibrationWalk,
                 VelocityPrior, BiasPrior, WheelCalibrationPrior, GaussianPrior>;

// A factor on its way into a graph, with the kernel that bounds its influence.
struct NewFactor {
  // A factor alone is meant exactly as it is.
  template <class F>
  requires std::is_constructible_v<AnyFactor, F> NewFactor(
      F&& f, const RobustKernel& k = {})  // NOLINT(google-explicit-constructor)
      : factor(std::forward<F>(f)), kernel(k) {}

  AnyFactor factor;
  RobustKernel kernel;
};

inline std::span<const Key> keys_of(const AnyFactor& factor) {
  return std::visit([](const auto& f) { return std::span<const Key>(f.keys()); }, factor);
}

inline std::string_view name_of(const AnyFactor& factor) {
  return std::visit([]<class F>(const F&) { return F::kName; }, factor);
}

inline double chi2_of(const AnyFactor& factor, const Values& values) {
  return std::visit([&](const auto& f) { return chi2_of(f, values); }, factor);
}

}  // namespace corridor::graph
