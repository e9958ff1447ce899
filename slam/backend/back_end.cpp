#include "slam/backend/back_end.hpp"

namespace corridor::backend {

std::string to_text(SolveStatus status) {
  constexpr const char* kNames[] = {"converged", "max_iterations", "rank_deficient", "not_finite",
                                    "empty"};
  return kNames[static_cast<std::size_t>(status)];
}

Result<void> BackEnd::marginalize(std::span<const graph::Key> keys) {
  if (keys.empty()) return {};
  return fail(ErrorCode::kInvalid, "variables cannot be marginalised", std::string(name()),
              "isam2");
}

}  // namespace corridor::backend
