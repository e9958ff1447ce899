// Parameters set by hand, in a suite or with --set, checked against the system they are for.
#pragma once

#include <string>

#include "bench/runner/systems.hpp"

namespace corridor::runner {

// Every value of the system's parameters. The Error lists all unknown names, each with those it may
// have been meant for, and all broken rules.
Result<ParamValues> resolve_overrides(const SystemInfo& info, const std::string& profile,
                                      const ParamValues& overrides);

}  // namespace corridor::runner
