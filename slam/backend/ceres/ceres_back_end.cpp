#include "slam/backend/ceres/ceres_back_end.hpp"

#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/types.h>
#include <glog/logging.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slam/backend/ceres/ceres_problem.hpp"
#include "slam/backend/ceres/unheld_variable.hpp"
#include "slam/core/expect.hpp"
#include "slam/linear/one_thread.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::Key;
using graph::NewFactor;
using graph::Values;

// Ceres speaks through glog, to the terminal; what it has to say is in our status.
class SilentLog {
 public:
  SilentLog() : level_before_(std::exchange(FLAGS_minloglevel, google::GLOG_FATAL)) {}
  ~SilentLog() { FLAGS_minloglevel = level_before_; }
  SilentLog(const SilentLog&) = delete;
  SilentLog& operator=(const SilentLog&) = delete;

 private:
  int level_before_;
};

// Among those this Ceres was built with.
std::optional<ceres::SparseLinearAlgebraLibraryType> find_library(const std::string& name) {
  auto library = ceres::NO_SPARSE;
  if (!ceres::StringToSparseLinearAlgebraLibraryType(name, &library) ||
      library == ceres::NO_SPARSE || !ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) {
    return std::nullopt;
  }
  return library;
}

bool is_finite_at(const graph::FactorGraph& graph, const Values& values) {
  bool is_finite = true;
  graph.for_each([&]<class F>(FactorId, const F& factor, const graph::RobustKernel&) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    factor.linearize(values, r, J);
    is_finite = is_finite && r.allFinite() && J.allFinite();
  });
  return is_finite;
}

class CeresBackEnd final : public BackEnd {
 public:
  explicit CeresBackEnd(const CeresParams& params) : params_(params), problem_(graph_) {
    CORRIDOR_EXPECT(params.relations().empty());
  }

  std::string_view name() const override { return "ceres"; }

  std::vector<FactorId> add(std::vector<NewFactor> new_factors, const Values& new_values) override {
    for (const Key key : new_values.keys()) {
      if (!problem_.variables().contains(key)) problem_.add_variable(key);
    }
    values_.merge(new_values);
    std::vector<FactorId> ids;
    for (NewFactor& factor : new_factors) {
      for (const Key key : graph::keys_of(factor.factor)) CORRIDOR_EXPECT(values_.contains(key));
      ids.push_back(graph_.add(std::move(factor)));
      problem_.add_factor(ids.back());
    }
    return ids;
  }

  BackEndReport update(std::vector<NewFactor> new_factors, const Values& new_values,
                       std::span<const FactorId> removed_factors) override {
    for (const FactorId id : removed_factors) {
      problem_.remove_factor(id);
      graph_.remove(id);
    }
    std::vector<FactorId> ids = add(std::move(new_factors), new_values);
    BackEndReport report = minimize(options(params_.update_iterations));
    report.new_factor_ids = std::move(ids);
    return report;
  }

  BackEndReport solve() override { return minimize(options(params_.max_iterations)); }
  // Ceres keeps its decrement to itself: here the decrease that a step brought is what has to be
  // small, or the gradient, if the settings ask for it.
  BackEndReport update_until_converged(const ConvergenceBudget& budget) override {
    ceres::Solver::Options to_goal = options(budget.max_rounds);
    to_goal.function_tolerance = budget.relative_decrement;
    to_goal.parameter_tolerance = 0;
    return minimize(to_goal);
  }
  void set_values(const Values& values) override { values_.merge(values); }
  const Values& estimate() const override { return values_; }
  const graph::FactorGraph& graph() const override { return graph_; }

  Result<Eigen::MatrixXd> marginal_covariance(Key key) override {
    const char* const where = "marginal covariance";
    if (!problem_.variables().contains(key)) {
      return fail(ErrorCode::kNotFound, "no variable " + graph::to_text(key), where);
    }
    const char* const expected = "a prior and factors that determine every variable";
    if (const auto unheld = find_unheld_variable(graph_, problem_.variables())) {
      return fail(ErrorCode::kInvalid, "nothing holds " + graph::to_text(*unheld), where, expected);
    }
    const SilentLog silence;
    problem_.set_blocks(values_);
    ceres::Covariance covariance({});
    const double* const block = problem_.block(key);
    Eigen::MatrixXd in_block(key.dimension(), key.dimension());
    if (!covariance.Compute(std::vector<const double*>{block}, &problem_.problem()) ||
        !covariance.GetCovarianceBlock(block, block, in_block.data())) {
      return fail(ErrorCode::kInvalid, "the Jacobian lacks full rank", where, expected);
    }
    if (key.kind != graph::VariableKind::kPose) return in_block;
    // From the map's axes to the pose's own.
    Eigen::Matrix3d tangent_from_block = Eigen::Matrix3d::Identity();
    tangent_from_block.topLeftCorner<2, 2>() = values_.oriented(key.index).rotation().transpose();
    return Eigen::MatrixXd(tangent_from_block * in_block * tangent_from_block.transpose());
  }

 private:
  ceres::Solver::Options options(int max_iterations) const {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = *find_library(params_.sparse_library);
    options.max_num_iterations = max_iterations;
    options.function_tolerance = params_.function_tolerance;
    options.gradient_tolerance = params_.gradient_tolerance;
    options.parameter_tolerance = params_.parameter_tolerance;
    options.initial_trust_region_radius = params_.initial_trust_region_radius;
    options.logging_type = ceres::SILENT;
    return options;
  }

  SolveStatus status_of(const ceres::Solver::Summary& summary) const {
    if (summary.termination_type == ceres::CONVERGENCE) return SolveStatus::kConverged;
    if (summary.termination_type == ceres::NO_CONVERGENCE) return SolveStatus::kMaxIterations;
    // Either the factors could not be evaluated where they were last, or step after step could not
    // be computed.
    return is_finite_at(graph_, problem_.last_point()) ? SolveStatus::kRankDeficient
                                                       : SolveStatus::kNotFinite;
  }

  BackEndReport minimize(const ceres::Solver::Options& options) {
    BackEndReport report;
    report.num_factors = static_cast<std::int64_t>(graph_.num_factors());
    report.num_variables = static_cast<std::int64_t>(problem_.variables().keys().size());
    if (report.num_factors == 0) return report;
    report.undetermined = find_unheld_variable(graph_, problem_.variables());
    if (report.undetermined) {
      report.chi2_initial = report.chi2 = graph_.cost(values_);
      report.status = SolveStatus::kRankDeficient;
      return report;
    }
    const SilentLog silence;
    problem_.set_blocks(values_);
    std::optional<linear::OneThread> one_thread;
    if (params_.use_one_thread) one_thread.emplace();
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_.problem(), &summary);
    report.status = status_of(summary);
    report.num_iterations = summary.num_linear_solves;
    if (!summary.IsSolutionUsable()) {
      report.chi2_initial = report.chi2 = graph_.cost(values_);
      return report;
    }
    problem_.get_blocks(values_);
    report.chi2_initial = 2 * summary.initial_cost;
    report.chi2 = 2 * summary.final_cost;
    report.num_relinearized = summary.num_successful_steps * report.num_variables;
    return report;
  }

  CeresParams params_;
  graph::FactorGraph graph_;
  Values values_;
  CeresProblem problem_;
};

}  // namespace

std::vector<std::string> CeresParams::relations() const {
  if (find_library(sparse_library)) return {};
  return {"sparse_library = \"" + sparse_library +
          "\": expected SUITE_SPARSE, CX_SPARSE or EIGEN_SPARSE"};
}

std::unique_ptr<BackEnd> make_ceres(const CeresParams& params) {
  return std::make_unique<CeresBackEnd>(params);
}

CeresParams tuned_ceres_params() {
  CeresParams params;
  params.initial_trust_region_radius = 1e16;  // Ceres' own limit
  params.use_one_thread = true;
  // Like our own solvers where solutions are compared to 1e-6: Ceres' own rules stop before that on
  // graphs that fit almost exactly.
  params.function_tolerance = 1e-9;
  params.gradient_tolerance = 0;
  // A floor for graphs that fit exactly, where the cost is rounding; about the step of 1e-8 at
  // which our own stop.
  params.parameter_tolerance = 1e-12;
  params.max_iterations = 100;
  return params;
}

}  // namespace corridor::backend
