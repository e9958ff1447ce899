// The system of a case that is given a log.
#pragma once

#include <memory>

#include "bench/runner/case_data.hpp"
#include "bench/runner/case_spec.hpp"
#include "bench/runner/systems.hpp"
#include "slam/core/result.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::runner {

// `wrap_back_end` as in SystemRequest. The Error: a system that takes graphs, or that needs sensors
// which the log does not have.
Result<std::unique_ptr<SlamSystem>> make_system(const CaseSpec& spec, const CaseData& data,
                                                WrapBackEnd wrap_back_end = {});

}  // namespace corridor::runner
