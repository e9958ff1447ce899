#include "bench/runner/back_ends.hpp"

#include <fmt/format.h>

#include <functional>
#include <utility>

#include "bench/runner/overrides.hpp"
#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/isam2/isam2.hpp"

namespace corridor::runner {
namespace {

using backend::BackEnd;
using backend::LeastSquaresParams;
using MadeBackEnd = Result<std::unique_ptr<BackEnd>>;

struct Entry {
  BackEndInfo info;
  std::function<MadeBackEnd(const LeastSquaresParams& settings, const ParamValues& overrides)> make;
  std::function<Result<ParamValues>(const LeastSquaresParams& settings,
                                    const ParamValues& overrides)>
      values;  // that make() takes
};

// params_of(settings) are its parameters where nothing is set by hand, make(params) makes it.
template <class ParamsOf, class Make>
Entry entry_of(std::string name, std::string description, ParamsOf params_of, Make make) {
  const std::vector<ParamRow> table = param_table(params_of(LeastSquaresParams()));
  const auto params_with = [=](const LeastSquaresParams& settings, const ParamValues& overrides) {
    const std::string where = "back-end " + name;
    return with_nearest_names(table, overrides, where,
                              "one of `corridor-bench list backends --json`",
                              [&](const ParamValues& known) {
                                return with_overrides(params_of(settings), known, where);
                              });
  };
  const auto make_with = [=](const auto& settings, const auto& overrides) -> MadeBackEnd {
    const auto params = params_with(settings, overrides);
    if (!params) return tl::make_unexpected(params.error());
    return make(*params);
  };
  const auto values = [=](const auto& settings, const auto& overrides) -> Result<ParamValues> {
    const auto params = params_with(settings, overrides);
    if (!params) return tl::make_unexpected(params.error());
    return param_values(*params);
  };
  return {{name, std::move(description), table, false}, make_with, values};
}

// `linear`: nothing leaves it as the system that asks has it.
Entry least_squares_entry(std::string name, std::string description, bool use_damping,
                          const std::optional<std::string>& linear = std::nullopt) {
  const auto params_of = [use_damping, linear](LeastSquaresParams settings) {
    settings.use_damping = use_damping;
    settings.linear = linear.value_or(settings.linear);
    return settings;
  };
  return entry_of(std::move(name), std::move(description), params_of, backend::make_least_squares);
}

// A back-end with parameters of its own, whatever system asks.
template <class P, class Make>
Entry own_entry(std::string name, std::string description, const P& params, Make make) {
  return entry_of(
      std::move(name), std::move(description),
      [params](const LeastSquaresParams&) { return params; }, make);
}

Entry fixed_lag_entry() {
  Entry entry = own_entry("fixed-lag", "isam2 on the newest poses; older ones are marginalised",
                          backend::FixedLagParams(), backend::make_fixed_lag);
  entry.info.forgets = true;
  return entry;
}

std::vector<Entry> entries() {
  return {least_squares_entry("gauss-newton", "batch Gauss-Newton on sparse Cholesky", false),
          least_squares_entry("gauss-newton@cholmod", "the same on SuiteSparse CHOLMOD", false,
                              "cholmod"),
          least_squares_entry("levenberg", "batch Levenberg-Marquardt on sparse Cholesky", true),
          own_entry("isam2", "incremental smoothing on the Bayes tree [Kaess2012]",
                    backend::Isam2Params(), backend::make_isam2),
          fixed_lag_entry(),
          own_entry("ceres", "Ceres Solver with its default settings, a third-party reference",
                    backend::CeresParams(), backend::make_ceres),
          own_entry("ceres@tuned", "Ceres Solver with the settings fastest on pose graphs",
                    backend::tuned_ceres_params(), backend::make_ceres)};
}

}  // namespace

std::vector<BackEndInfo> back_ends() {
  std::vector<BackEndInfo> infos;
  for (Entry& entry : entries()) infos.push_back(std::move(entry.info));
  return infos;
}

std::optional<BackEndInfo> find_back_end(std::string_view name) {
  for (const BackEndInfo& info : back_ends()) {
    if (info.name == name) return info;
  }
  return std::nullopt;
}

Result<void> check_back_end(std::string_view name) {
  if (find_back_end(name)) return {};
  std::string known;
  for (const BackEndInfo& info : back_ends()) known += (known.empty() ? "" : " ") + info.name;
  return fail(ErrorCode::kNotFound, fmt::format("unknown back-end \"{}\"", name), "",
              "one of: " + known);
}

Result<std::unique_ptr<BackEnd>> make_back_end(std::string_view name,
                                               const LeastSquaresParams& settings,
                                               const ParamValues& overrides) {
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry.make(settings, overrides);
  }
  return tl::make_unexpected(check_back_end(name).error());
}

Result<ParamValues> back_end_parameters(std::string_view name, const LeastSquaresParams& settings,
                                        const ParamValues& overrides) {
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry.values(settings, overrides);
  }
  return tl::make_unexpected(check_back_end(name).error());
}

}  // namespace corridor::runner
