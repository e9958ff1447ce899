#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "slam/backend/gauss_newton/normal_equations.hpp"
#include "slam/core/enum_text.hpp"
#include "slam/core/expect.hpp"
#include "slam/linear/make_linear_solver.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::Key;
using graph::NewFactor;
using graph::Values;

class LeastSquares final : public BackEnd {
 public:
  explicit LeastSquares(const LeastSquaresParams& params) : params_(params) {
    const auto kind = from_text(linear::kLinearSolvers, params.linear);
    CORRIDOR_EXPECT(kind.has_value());
    cholesky_ = linear::make_linear_solver(*kind);
  }

  std::string_view name() const override {
    return params_.use_damping ? "levenberg" : "gauss-newton";
  }

  std::vector<FactorId> add(std::vector<NewFactor> new_factors, const Values& new_values) override {
    for (const Key key : new_values.keys()) {
      if (!equations_.contains(key)) equations_.add_variable(key);
    }
    values_.merge(new_values);
    std::vector<FactorId> ids;
    for (NewFactor& factor : new_factors) {
      for (const Key key : graph::keys_of(factor.factor)) CORRIDOR_EXPECT(values_.contains(key));
      const FactorId id = graph_.add(std::move(factor));
      equations_.add_factor(id, graph_);
      ids.push_back(id);
    }
    return ids;
  }

  BackEndReport update(std::vector<NewFactor> new_factors, const Values& new_values,
                       std::span<const FactorId> removed_factors) override {
    for (const FactorId id : removed_factors) graph_.remove(id);
    std::vector<FactorId> ids = add(std::move(new_factors), new_values);
    BackEndReport report = minimize(params_.update_iterations, nullptr);
    report.new_factor_ids = std::move(ids);
    return report;
  }

  BackEndReport solve() override { return minimize(params_.max_iterations, nullptr); }
  BackEndReport update_until_converged(const ConvergenceBudget& budget) override {
    return minimize(budget.max_rounds, &budget);
  }
  void set_values(const Values& values) override { values_.merge(values); }
  const Values& estimate() const override { return values_; }
  const graph::FactorGraph& graph() const override { return graph_; }

  Result<Eigen::MatrixXd> marginal_covariance(Key key) override {
    if (!equations_.contains(key)) {
      return fail(ErrorCode::kNotFound, "no variable " + graph::to_text(key),
                  "marginal covariance");
    }
    equations_.linearize(graph_, values_);
    if (cholesky_->factorize(equations_.hessian()) != linear::CholeskyStatus::kOk) {
      return fail(ErrorCode::kInvalid, "the normal equations are singular" + place_of_failure(),
                  "marginal covariance", "a prior and factors that determine every variable");
    }
    const int row = equations_.first_row(key);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(equations_.gradient().rows(), key.dimension());
    unit.middleRows(row, key.dimension()).setIdentity();
    Eigen::MatrixXd columns(unit.rows(), unit.cols());  // of the inverse Hessian
    cholesky_->solve(unit, columns);
    return Eigen::MatrixXd(columns.middleRows(row, key.dimension()));
  }

 private:
  BackEndReport begin_report() const {
    BackEndReport report;
    report.num_factors = static_cast<std::int64_t>(graph_.num_factors());
    report.num_variables = static_cast<std::int64_t>(equations_.variables().size());
    return report;
  }

  // The variable at which the last factorisation broke down, if it was one.
  std::optional<Key> undetermined() const {
    const int variable = cholesky_->first_bad_variable();
    if (variable < 0) return std::nullopt;
    return equations_.variables()[static_cast<std::size_t>(variable)];
  }
  std::string place_of_failure() const {
    const std::optional<Key> key = undetermined();
    return key ? " at " + graph::to_text(*key) : "";
  }

  // delta_ of (H + lambda diag(H)) delta = -g.
  bool solve_step(double lambda) {
    if (cholesky_->factorize(equations_.hessian(), lambda) != linear::CholeskyStatus::kOk) {
      return false;
    }
    delta_.resize(equations_.gradient().rows());
    cholesky_->solve(-equations_.gradient(), delta_);
    return delta_.allFinite();
  }

  // goal: stops when the decrement is as small as it says, instead of by the thresholds of params_.
  BackEndReport minimize(int max_iterations, const ConvergenceBudget* goal) {
    BackEndReport report = begin_report();
    if (report.num_factors == 0) return report;
    report.chi2_initial = report.chi2 = equations_.linearize(graph_, values_);
    is_linearized_ = true;
    if (!std::isfinite(report.chi2)) {
      report.status = SolveStatus::kNotFinite;
      return report;
    }
    report.status = SolveStatus::kMaxIterations;
    Damping damping{params_.use_damping ? params_.initial_lambda : 0, params_.lambda_increase};
    while (report.num_iterations < max_iterations && report.status == SolveStatus::kMaxIterations) {
      ++report.num_iterations;
      iterate(damping, report.num_iterations == max_iterations, goal, report);
    }
    report.num_factor_nonzeros = static_cast<std::int64_t>(cholesky_->num_factor_nonzeros());
    return report;
  }

  struct Damping {
    double lambda;
    double increase;
  };

  // The cost at the present estimate. A plain step always stands, so that the linearisation for
  // the next one gives it along; a damped step may be taken back, and then H is needed again.
  double evaluate(bool is_last_step) {
    is_linearized_ = !params_.use_damping && !is_last_step;
    return is_linearized_ ? equations_.linearize(graph_, values_) : graph_.cost(values_);
  }

  bool is_promise_small(const ConvergenceBudget& goal, BackEndReport& report) const {
    report.decrement = -equations_.gradient().dot(delta_);
    return is_small_decrement(report.decrement, report.chi2, report.num_variables, goal);
  }

  // delta_ of the next step: whether it is so short that it is the last; nothing if there is none.
  // Damping makes steps short wherever they start: then the step without it decides.
  std::optional<bool> find_step(double lambda, const ConvergenceBudget* goal,
                                BackEndReport& report) {
    if (!solve_step(lambda)) return std::nullopt;
    if (goal == nullptr) return delta_.squaredNorm() < params_.min_squared_step;
    if (!is_promise_small(*goal, report)) return false;
    if (lambda == 0 || (solve_step(0) && is_promise_small(*goal, report))) return true;
    if (!solve_step(lambda)) return std::nullopt;
    return false;
  }

  // One step from the present estimate: taken or taken back, with the status that follows.
  void iterate(Damping& damping, bool is_last, const ConvergenceBudget* goal,
               BackEndReport& report) {
    if (!is_linearized_) equations_.linearize(graph_, values_);
    const std::optional<bool> is_short = find_step(damping.lambda, goal, report);
    if (!is_short) {
      report.status = SolveStatus::kRankDeficient;
      report.undetermined = undetermined();
      return;
    }
    before_ = values_;
    values_.retract(equations_.variables(), delta_.data());
    report.num_relinearized += report.num_variables;
    const double chi2 = evaluate(is_last || *is_short);
    // Damped steps are judged by chi2; plain ones always stand.
    if (std::isfinite(chi2) && (!params_.use_damping || chi2 < report.chi2)) {
      const double decrease = std::abs(report.chi2 - chi2);
      const bool is_flat = goal == nullptr && params_.min_relative_decrease > 0 &&
                           decrease <= params_.min_relative_decrease * report.chi2;
      report.chi2 = chi2;
      damping.lambda *= params_.lambda_decrease;
      if (*is_short || is_flat) report.status = SolveStatus::kConverged;
      return;
    }
    std::swap(values_, before_);
    is_linearized_ = true;
    if (!params_.use_damping) {
      report.status = SolveStatus::kNotFinite;
    } else if (*is_short) {
      report.status = SolveStatus::kConverged;
    } else {
      damping.lambda *= damping.increase;
      damping.increase *= 2;
    }
  }

  LeastSquaresParams params_;
  graph::FactorGraph graph_;
  Values values_;
  NormalEquations equations_;
  std::unique_ptr<linear::LinearSolver> cholesky_;
  // Of the solution under way.
  bool is_linearized_ = false;  // the equations are those of the present estimate
  Eigen::VectorXd delta_;
  Values before_;  // the estimate before the last step
};

}  // namespace

std::vector<std::string> LeastSquaresParams::relations() const {
  if (from_text(linear::kLinearSolvers, linear)) return {};
  return {"linear = \"" + linear + "\": expected block or cholmod"};
}

std::unique_ptr<BackEnd> make_least_squares(const LeastSquaresParams& params) {
  return std::make_unique<LeastSquares>(params);
}

LeastSquaresParams spa_params() {
  LeastSquaresParams params;
  params.use_damping = true;
  params.max_iterations = 40;
  params.min_relative_decrease = 0;
  return params;
}

}  // namespace corridor::backend
