// Makes a table entry from a parameter struct, its profiles and a factory. Included by systems.cpp
// only.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bench/runner/systems.hpp"

namespace corridor::runner {

template <class P>
struct Profile {
  std::string name;
  std::string description;
  P params;
};

// The entry's profiles and parameters. Returns params_of(profile, overrides) -> Result<P>.
template <class P>
auto set_profiles(SystemInfo& info, const std::vector<Profile<P>>& profiles) {
  for (const Profile<P>& profile : profiles) {
    info.profiles.push_back({profile.name, profile.description});
  }
  // The profile was checked by whoever parsed the name; an unknown one is an Error all the same.
  const auto params_of = [name = info.name, profiles](const std::string& profile,
                                                      const ParamValues& overrides) -> Result<P> {
    const auto found = std::find_if(profiles.begin(), profiles.end(),
                                    [&](const Profile<P>& p) { return p.name == profile; });
    if (found == profiles.end()) {
      return fail(ErrorCode::kNotFound, "unknown profile \"" + profile + "\" of system " + name);
    }
    return with_overrides(found->params, overrides, "system " + name);
  };
  info.param_table = [params_of](const std::string& profile) {
    const Result<P> params = params_of(profile, {});
    return params ? corridor::param_table(*params) : std::vector<ParamRow>{};
  };
  info.resolve = [params_of](const std::string& profile,
                             const ParamValues& overrides) -> Result<ParamValues> {
    const Result<P> params = params_of(profile, overrides);
    if (!params) return tl::make_unexpected(params.error());
    return param_values(*params);
  };
  return params_of;
}

// `Make` is called as make(params, request) and returns Result<std::unique_ptr<SlamSystem>>.
template <class P, class Make>
void set_factory(SystemInfo& info, const std::vector<Profile<P>>& profiles, Make make) {
  info.make = [params_of = set_profiles(info, profiles), make = std::move(make)](
                  const SystemRequest& request) -> Result<std::unique_ptr<SlamSystem>> {
    const Result<P> params = params_of(request.profile, request.overrides);
    if (!params) return tl::make_unexpected(params.error());
    return make(*params, request);
  };
}

// An entry that is given graphs.
template <class P>
void set_graph_task(SystemInfo& info, const std::vector<Profile<P>>& profiles) {
  info.graph_task = [params_of = set_profiles(info, profiles)](
                        const std::string& profile,
                        const ParamValues& overrides) -> Result<GraphTask> {
    const Result<P> params = params_of(profile, overrides);
    if (!params) return tl::make_unexpected(params.error());
    return task_of(*params);
  };
}

}  // namespace corridor::runner
