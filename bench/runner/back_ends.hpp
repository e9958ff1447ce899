// The back-ends that graph-based systems can be given, by name.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct BackEndInfo {
  std::string name;  // NAME, or NAME@PROFILE where one back-end has several settings
  std::string description;
  std::vector<ParamRow> parameters;  // as the back-end has them where no system says otherwise
  bool forgets = false;              // old poses, as new ones come: of no use all at once
};

std::vector<BackEndInfo> back_ends();
// Nothing for an unknown name.
std::optional<BackEndInfo> find_back_end(std::string_view name);

// The Error names the known ones.
Result<void> check_back_end(std::string_view name);

// `settings` are the limits and thresholds of the system that asks, for the least-squares solvers
// of our own; the name decides the method. The others run with their own parameters. `overrides`
// come on top of either; the Error lists all unknown ones, each with those it may have been meant
// for, and all broken rules.
Result<std::unique_ptr<backend::BackEnd>> make_back_end(std::string_view name,
                                                        const backend::LeastSquaresParams& settings,
                                                        const ParamValues& overrides = {});

// All parameters that it has then, by name.
Result<ParamValues> back_end_parameters(std::string_view name,
                                        const backend::LeastSquaresParams& settings,
                                        const ParamValues& overrides = {});

}  // namespace corridor::runner
