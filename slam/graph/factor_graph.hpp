// A set of factors with stable numbers.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/graph/factor.hpp"

namespace corridor::graph {

using FactorId = std::size_t;

class FactorGraph {
 public:
  FactorId add(FactorPtr factor);
  // The number is never given again. Requires contains(id).
  void remove(FactorId id);
  [[nodiscard]] bool contains(FactorId id) const {
    return id < factors_.size() && factors_[id] != nullptr;
  }
  // Requires contains(id).
  [[nodiscard]] const Factor& factor(FactorId id) const { return *factors_[id]; }
  // Removed factors are null.
  [[nodiscard]] const std::vector<FactorPtr>& slots() const { return factors_; }
  [[nodiscard]] std::size_t num_factors() const { return num_factors_; }
  [[nodiscard]] double chi2(const Values& values) const;

 private:
  std::vector<FactorPtr> factors_;
  std::size_t num_factors_ = 0;
};

}  // namespace corridor::graph
