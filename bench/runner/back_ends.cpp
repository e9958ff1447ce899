#include "bench/runner/back_ends.hpp"

#include <fmt/format.h>

#include <functional>
#include <utility>

#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/isam2/isam2.hpp"

namespace corridor::runner {
namespace {

using backend::BackEnd;
using backend::LeastSquaresParams;

struct Entry {
  BackEndInfo info;
  std::function<std::unique_ptr<BackEnd>(const LeastSquaresParams& settings)> make;
};

Entry least_squares_entry(std::string name, std::string description, bool use_damping) {
  LeastSquaresParams params;
  params.use_damping = use_damping;
  return {{std::move(name), std::move(description), param_table(params)},
          [use_damping](LeastSquaresParams settings) {
            settings.use_damping = use_damping;
            return backend::make_least_squares(settings);
          }};
}

Entry ceres_entry(std::string name, std::string description, const backend::CeresParams& params) {
  return {{std::move(name), std::move(description), param_table(params)},
          [params](const LeastSquaresParams&) { return backend::make_ceres(params); }};
}

Entry isam2_entry() {
  return {{"isam2", "incremental smoothing on the Bayes tree [Kaess2012]",
           param_table(backend::Isam2Params())},
          [](const LeastSquaresParams&) { return backend::make_isam2({}); }};
}

std::vector<Entry> entries() {
  return {
      least_squares_entry("gauss-newton", "batch Gauss-Newton on sparse Cholesky", false),
      least_squares_entry("levenberg", "batch Levenberg-Marquardt on sparse Cholesky", true),
      isam2_entry(),
      ceres_entry("ceres", "Ceres Solver with its default settings, a third-party reference", {}),
      ceres_entry("ceres@tuned", "Ceres Solver with the settings fastest on pose graphs",
                  backend::tuned_ceres_params())};
}

}  // namespace

std::vector<BackEndInfo> back_ends() {
  std::vector<BackEndInfo> infos;
  for (Entry& entry : entries()) infos.push_back(std::move(entry.info));
  return infos;
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

Result<std::unique_ptr<BackEnd>> make_back_end(std::string_view name,
                                               const LeastSquaresParams& settings) {
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry.make(settings);
  }
  return tl::make_unexpected(check_back_end(name).error());
}

}  // namespace corridor::runner
