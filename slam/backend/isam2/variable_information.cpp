#include "slam/backend/isam2/variable_information.hpp"

namespace corridor::backend {

void InformationTable::add_variable(int variable, int dimension) {
  const auto number = static_cast<std::size_t>(variable);
  if (number >= all_.size()) all_.resize(number + 1);
  Entry& own = entry(variable);
  if (own.dimension != dimension) {
    own = {numbers_.size(), dimension, State::kKnown};
    numbers_.resize(numbers_.size() + static_cast<std::size_t>(dimension * dimension));
  }
  reset(variable);
}

double InformationTable::squared_length(int variable, graph::VariableKind kind,
                                        const double* step) {
  using Kind = graph::VariableKind;
  if (kind == Kind::kVelocity || kind == Kind::kBias) return 0;
  const Block block = H(variable);
  const Eigen::Map<const Eigen::VectorXd> x(step, block.rows());
  return x.dot(block.lazyProduct(x));
}

void InformationTable::forget(int variable) {
  State& state = entry(variable).state;
  if (state == State::kKnown) state = State::kUnknown;
}

void InformationTable::reset(int variable) {
  H(variable).setZero();
  entry(variable).state = State::kKnown;
}

void InformationTable::begin_sum(int variable) {
  reset(variable);
  entry(variable).state = State::kBeingSummed;
  being_summed_.push_back(variable);
}

void InformationTable::end_sums(bool is_whole) {
  for (const int variable : being_summed_) {
    entry(variable).state = is_whole ? State::kKnown : State::kUnknown;
  }
  being_summed_.clear();
}

}  // namespace corridor::backend
