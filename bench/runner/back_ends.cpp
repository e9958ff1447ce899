#include "bench/runner/back_ends.hpp"

#include <fmt/format.h>

namespace corridor::runner {

std::vector<BackEndInfo> back_ends() {
  return {{"gauss-newton", "batch Gauss-Newton on sparse Cholesky (CHOLMOD)"},
          {"levenberg", "batch Levenberg-Marquardt on sparse Cholesky (CHOLMOD)"}};
}

Result<void> check_back_end(std::string_view name) {
  std::string known;
  for (const BackEndInfo& info : back_ends()) {
    if (info.name == name) return {};
    known += (known.empty() ? "" : " ") + info.name;
  }
  return fail(ErrorCode::kNotFound, fmt::format("unknown back-end \"{}\"", name), "",
              "one of: " + known);
}

Result<std::unique_ptr<backend::BackEnd>> make_back_end(std::string_view name,
                                                        backend::LeastSquaresParams settings) {
  if (const Result<void> known = check_back_end(name); !known) {
    return tl::make_unexpected(known.error());
  }
  settings.use_damping = name == "levenberg";
  return backend::make_least_squares(settings);
}

}  // namespace corridor::runner
