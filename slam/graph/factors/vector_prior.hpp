// Priors on the variables that are plain vectors: velocity, bias, wheel calibration.
#pragma once

#include <array>
#include <string_view>

#include "slam/core/expect.hpp"
#include "slam/graph/factor.hpp"

namespace corridor::graph {

// e = (x - prior) / sigma, component by component.
template <VariableKind kKind>
class VectorPrior {
 public:
  static constexpr std::string_view kName = "vector_prior";
  static constexpr int kRows = dimension_of(kKind);
  static constexpr bool kIsLinear = true;
  static constexpr std::array kKinds = {kKind};
  using Vector = FixedVector<kRows>;

  // In the unit of the variable; every sigma > 0.
  VectorPrior(std::uint32_t index, const Vector& prior, const Vector& sigma)
      : keys_{Key{kKind, index}}, prior_(prior), inverse_sigma_(sigma.cwiseInverse()) {
    CORRIDOR_EXPECT((sigma.array() > 0).all());
  }

  [[nodiscard]] const std::array<Key, 1>& keys() const { return keys_; }
  void linearize(const Values& values, Vector& r, FixedMatrix<kRows, kRows>& J) const {
    residual(values, r);
    J = inverse_sigma_.asDiagonal();
  }
  void residual(const Values& values, Vector& r) const {
    r = inverse_sigma_.cwiseProduct(values.vector<kKind>(keys_[0].index) - prior_);
  }

 private:
  std::array<Key, 1> keys_;
  Vector prior_, inverse_sigma_;
};

using VelocityPrior = VectorPrior<VariableKind::kVelocity>;
using BiasPrior = VectorPrior<VariableKind::kBias>;
using WheelCalibrationPrior = VectorPrior<VariableKind::kWheelCalibration>;

}  // namespace corridor::graph
