#include "slam/backend/back_end.hpp"

#include <algorithm>

namespace corridor::backend {

std::string to_text(SolveStatus status) {
  constexpr const char* kNames[] = {"converged", "max_iterations", "rank_deficient", "not_finite",
                                    "empty"};
  return kNames[static_cast<std::size_t>(status)];
}

bool has_failed(SolveStatus status) {
  return status == SolveStatus::kRankDeficient || status == SolveStatus::kNotFinite;
}

bool is_small_decrement(double decrement, double cost, std::int64_t num_variables,
                        const ConvergenceBudget& budget) {
  // Sums of squares that cancel are known to about this share; a step of a hundred-millionth of a
  // standard deviation per variable is what rounding leaves where the cost itself is nearly zero.
  constexpr double kRounding = 1e-14, kNegligibleStep = 1e-8;
  const double share = std::max(budget.relative_decrement, kRounding);
  return decrement <=
         share * cost + static_cast<double>(num_variables) * kNegligibleStep * kNegligibleStep;
}

Result<void> BackEnd::marginalize(std::span<const graph::Key> keys) {
  if (keys.empty()) return {};
  return fail(ErrorCode::kInvalid, "variables cannot be marginalised", std::string(name()),
              "isam2");
}

}  // namespace corridor::backend
