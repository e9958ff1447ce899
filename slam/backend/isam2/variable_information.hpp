// What the factors of each variable say on it alone, H_vv = sum of J_v^T J_v: the measure of its
// step from its linearisation point, in standard deviations.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace corridor::backend {

struct VariableInformation {
  enum class State { kUnknown, kKnown, kBeingSummed };

  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  // in the top left block of the dimension
  State state = State::kKnown;                  // of a variable without factors

  // step^T H step.
  [[nodiscard]] double squared_length(const double* step, int dimension) const;
};

// By the variable's number.
class InformationTable {
 public:
  // A number that is new or given again: no factor yet.
  void add_variable(int variable);
  [[nodiscard]] VariableInformation& operator[](int variable) {
    return all_[static_cast<std::size_t>(variable)];
  }
  [[nodiscard]] std::span<VariableInformation> all() { return all_; }

  // A factor has gone, or weighs otherwise: what is known is of no use.
  void forget(int variable);
  // All its factors are about to be linearised: what they say replaces what is known.
  void begin_sum(int variable);
  // is_whole: all were.
  void end_sums(bool is_whole);

 private:
  std::vector<VariableInformation> all_;
  std::vector<int> being_summed_;
};

}  // namespace corridor::backend
