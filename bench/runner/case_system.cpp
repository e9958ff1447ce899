#include "bench/runner/case_system.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/runner/overrides.hpp"

namespace corridor::runner {

Result<std::unique_ptr<SlamSystem>> make_system(const CaseSpec& spec, const CaseData& data,
                                                WrapBackEnd wrap_back_end) {
  const Result<SystemInfo> info = find_system(spec.system);
  if (!info) return tl::make_unexpected(info.error());
  if (info->takes_graphs()) {
    return fail(ErrorCode::kInvalid, fmt::format("system {} needs a pose graph", spec.system),
                spec.dataset, "data_kind graph");
  }
  if (const auto missing = missing_sensor(*info, sensors_of(data.log))) {
    return fail(ErrorCode::kInvalid, fmt::format("system {} needs {}", spec.system, *missing),
                spec.dataset, "a log with readings of each sensor that it needs");
  }
  CaseOverrides overrides = split_overrides(spec.overrides, spec.backend);
  return info->make({spec.profile, std::move(overrides.system), spec.backend, data.log.robot,
                     spec.system_seed, spec.threads, std::move(overrides.back_end),
                     std::move(wrap_back_end)});
}

}  // namespace corridor::runner
