#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"

#include <cmath>

#include "slam/backend/gauss_newton/normal_equations.hpp"
#include "slam/core/expect.hpp"
#include "slam/linear/sparse_cholesky.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::Key;
using graph::NewFactor;
using graph::Values;

class LeastSquares final : public BackEnd {
 public:
  explicit LeastSquares(const LeastSquaresParams& params) : params_(params) {}

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
    BackEndReport report = minimize(params_.update_iterations);
    report.new_factor_ids = std::move(ids);
    return report;
  }

  BackEndReport solve() override { return minimize(params_.max_iterations); }
  void set_values(const Values& values) override { values_.merge(values); }
  const Values& estimate() const override { return values_; }
  const graph::FactorGraph& graph() const override { return graph_; }

  Result<Eigen::MatrixXd> marginal_covariance(Key key) override {
    if (!equations_.contains(key)) {
      return fail(ErrorCode::kNotFound, "no variable " + graph::to_text(key),
                  "marginal covariance");
    }
    equations_.linearize(graph_, values_);
    if (cholesky_.factorize(equations_.hessian()) != linear::CholeskyStatus::kOk) {
      return fail(ErrorCode::kInvalid, "the normal equations are singular", "marginal covariance",
                  "a prior and factors that determine every variable");
    }
    const int row = equations_.first_row(key);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(equations_.gradient().rows(), key.dimension());
    unit.middleRows(row, key.dimension()).setIdentity();
    Eigen::MatrixXd columns(unit.rows(), unit.cols());  // of the inverse Hessian
    cholesky_.solve(unit, columns);
    return Eigen::MatrixXd(columns.middleRows(row, key.dimension()));
  }

 private:
  BackEndReport begin_report() const {
    BackEndReport report;
    report.num_factors = static_cast<std::int64_t>(graph_.num_factors());
    report.num_variables = static_cast<std::int64_t>(equations_.variables().size());
    return report;
  }

  // delta of (H + lambda diag(H)) delta = -g.
  bool solve_step(double lambda, Eigen::VectorXd& delta) {
    if (cholesky_.factorize(equations_.hessian(), lambda) != linear::CholeskyStatus::kOk) {
      return false;
    }
    delta.resize(equations_.gradient().rows());
    cholesky_.solve(-equations_.gradient(), delta);
    return delta.allFinite();
  }

  void apply(const Eigen::VectorXd& delta) {
    int row = 0;
    for (const Key key : equations_.variables()) {
      values_.retract(key, delta.data() + row);
      row += key.dimension();
    }
  }

  BackEndReport minimize(int max_iterations) {
    BackEndReport report = begin_report();
    if (report.num_factors == 0) return report;
    report.chi2_initial = report.chi2 = equations_.linearize(graph_, values_);
    if (!std::isfinite(report.chi2)) {
      report.status = SolveStatus::kNotFinite;
      return report;
    }
    report.status = SolveStatus::kMaxIterations;
    Damping damping{params_.use_damping ? params_.initial_lambda : 0, params_.lambda_increase};
    while (report.num_iterations < max_iterations && report.status == SolveStatus::kMaxIterations) {
      if (report.num_iterations > 0) equations_.linearize(graph_, values_);
      iterate(damping, report);
    }
    return report;
  }

  struct Damping {
    double lambda;
    double increase;
  };

  // One step from the present linearisation: taken or taken back, with the status that follows.
  void iterate(Damping& damping, BackEndReport& report) {
    Eigen::VectorXd delta;
    ++report.num_iterations;
    if (!solve_step(damping.lambda, delta)) {
      report.status = SolveStatus::kRankDeficient;
      return;
    }
    const Values before = values_;
    apply(delta);
    report.num_relinearized += report.num_variables;
    const double chi2 = graph_.cost(values_);
    const bool is_short = delta.squaredNorm() < params_.min_squared_step;
    // Damped steps are judged by chi2; plain ones always stand.
    if (std::isfinite(chi2) && (!params_.use_damping || chi2 < report.chi2)) {
      const double decrease = std::abs(report.chi2 - chi2);
      const bool is_flat = params_.min_relative_decrease > 0 &&
                           decrease <= params_.min_relative_decrease * report.chi2;
      report.chi2 = chi2;
      damping.lambda *= params_.lambda_decrease;
      if (is_short || is_flat) report.status = SolveStatus::kConverged;
      return;
    }
    values_ = before;
    if (!params_.use_damping) {
      report.status = SolveStatus::kNotFinite;
    } else if (is_short) {
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
  linear::SparseCholesky cholesky_;
};

}  // namespace

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
