// The back-ends that graph-based systems can be given, by name.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct BackEndInfo {
  std::string name;
  std::string description;
};

std::vector<BackEndInfo> back_ends();

// The Error names the known ones.
Result<void> check_back_end(std::string_view name);

// `settings` are the caller's limits and thresholds; the name decides the method.
Result<std::unique_ptr<backend::BackEnd>> make_back_end(std::string_view name,
                                                        backend::LeastSquaresParams settings);

}  // namespace corridor::runner
