// What the factors of each variable say on it alone, H_vv = sum of J_v^T J_v: the measure of its
// step from its linearisation point, in standard deviations. Linear factors do not count: they say
// the same at every point.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "slam/graph/key.hpp"

namespace corridor::backend {

// By the variable's number.
class InformationTable {
 public:
  enum class State { kUnknown, kKnown, kBeingSummed };
  using Block = Eigen::Map<Eigen::MatrixXd>;

  // A number that is new or given again: no factor yet.
  void add_variable(int variable, int dimension);
  [[nodiscard]] State state(int variable) const { return entry(variable).state; }
  // dimension x dimension; valid until the next add_variable().
  [[nodiscard]] Block H(int variable) {
    const Entry& own = entry(variable);
    return {&numbers_[own.begin], own.dimension, own.dimension};
  }
  // step^T H step; 0 for velocities and biases, in which every factor is linear.
  [[nodiscard]] double squared_length(int variable, graph::VariableKind kind, const double* step);

  // A factor has gone, or weighs otherwise: what is known is of no use.
  void forget(int variable);
  // To sum it anew right away: zero, and known.
  void reset(int variable);
  // All its factors are about to be linearised: what they say replaces what is known.
  void begin_sum(int variable);
  // is_whole: all were.
  void end_sums(bool is_whole);

 private:
  struct Entry {
    std::size_t begin = 0;  // of its block among the numbers
    int dimension = 0;
    State state = State::kKnown;  // of a variable without factors
  };
  [[nodiscard]] Entry& entry(int variable) { return all_[static_cast<std::size_t>(variable)]; }
  [[nodiscard]] const Entry& entry(int variable) const {
    return all_[static_cast<std::size_t>(variable)];
  }

  std::vector<Entry> all_;
  std::vector<double> numbers_;
  std::vector<int> being_summed_;
};

}  // namespace corridor::backend
