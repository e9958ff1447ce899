#include "slam/backend/isam2/variable_information.hpp"

namespace corridor::backend {
namespace {

using State = VariableInformation::State;

}  // namespace

double VariableInformation::squared_length(const double* step, int dimension) const {
  const Eigen::Map<const Eigen::VectorXd> x(step, dimension);
  return x.dot(H.topLeftCorner(dimension, dimension) * x);
}

void InformationTable::add_variable(int variable) {
  const auto number = static_cast<std::size_t>(variable);
  if (number >= all_.size()) all_.resize(number + 1);
  all_[number] = {};
}

void InformationTable::forget(int variable) {
  State& state = (*this)[variable].state;
  if (state == State::kKnown) state = State::kUnknown;
}

void InformationTable::begin_sum(int variable) {
  (*this)[variable] = {Eigen::Matrix3d::Zero(), State::kBeingSummed};
  being_summed_.push_back(variable);
}

void InformationTable::end_sums(bool is_whole) {
  for (const int variable : being_summed_) {
    (*this)[variable].state = is_whole ? State::kKnown : State::kUnknown;
  }
  being_summed_.clear();
}

}  // namespace corridor::backend
