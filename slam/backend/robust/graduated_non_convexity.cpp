#include "slam/backend/robust/graduated_non_convexity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "slam/core/chi_squared.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::KernelKind;
using graph::NewFactor;
using graph::RobustKernel;

class Gnc {
 public:
  Gnc(const graph::FactorGraph& graph, const graph::Values& initial,
      std::span<const FactorId> suspects, GncLoss loss, const GncParams& params)
      : graph_(graph), suspects_(suspects), loss_(loss), params_(params) {
    result_.values = initial;
    result_.weights.assign(suspects.size(), 1.0);
    std::map<int, double> bounds;  // by rows
    for (std::size_t k = 0; k < suspects.size(); ++k) {
      const int rows = graph.visit(
          suspects[k], [](const auto& factor, const auto&) { return graph::num_rows(factor); });
      const auto [bound, is_new] = bounds.try_emplace(rows, 0);
      if (is_new) bound->second = chi_squared_quantile(params.inlier_probability, rows);
      bounds_.push_back(bound->second);
      number_of_.emplace(suspects[k], k);
    }
  }

  GncResult run(const MakeBackEnd& make_back_end) {
    double cost = std::numeric_limits<double>::infinity();
    double mu = 0;
    while (result_.num_rounds < params_.max_rounds) {
      if (!(result_.num_rounds == 0 ? solve_at_full_weight(make_back_end) : solve(make_back_end))) {
        return finish(GncStatus::kNotSolvable, mu);
      }
      const std::vector<double> ratios = residual_ratios();
      if (result_.num_rounds == 1) {
        const auto worst = std::max_element(ratios.begin(), ratios.end());
        // All within their bounds, or nobody suspected: the plain solution stands.
        if (worst == ratios.end() || *worst <= 1) return finish(GncStatus::kConverged, mu);
        mu = first_mu(*worst);
      } else if (has_converged(mu, cost)) {
        return finish(GncStatus::kConverged, mu);
      } else {
        cost = result_.solution.chi2;
        mu = next_mu(mu);
      }
      for (std::size_t k = 0; k < ratios.size(); ++k) {
        result_.weights[k] = gnc_weight(loss_, ratios[k], mu);
      }
    }
    return finish(GncStatus::kMaxRounds, mu);
  }

 private:
  [[nodiscard]] double first_mu(double worst) const {
    return loss_ == GncLoss::kTruncated ? 1 / (2 * worst - 1) : 2 * worst;
  }
  [[nodiscard]] double next_mu(double mu) const {
    if (loss_ == GncLoss::kTruncated) return mu * params_.mu_factor;
    return std::max(1.0, mu / params_.mu_factor);
  }

  // Sum of min(r^2, c^2) over the suspects, and what the others cost: what GNC is after.
  [[nodiscard]] double bounded_cost(const graph::Values& values) const {
    double sum = 0;
    graph_.for_each([&](FactorId id, const auto& factor, const RobustKernel& kernel) {
      const double chi2 = graph::chi2_of(factor, values);
      const auto suspect = number_of_.find(id);
      sum += suspect == number_of_.end() ? kernel.cost(chi2)
                                         : std::min(chi2, bounds_[suspect->second]);
    });
    return sum;
  }

  // With false factors in full force a local solver may end anywhere, or nowhere: then the rounds
  // start at the initial values.
  bool solve_at_full_weight(const MakeBackEnd& make_back_end) {
    graph::Values initial = result_.values;
    const bool is_solved = solve(make_back_end);
    if (!is_solved || bounded_cost(initial) < bounded_cost(result_.values)) {
      result_.values = std::move(initial);
    }
    return is_solved || !suspects_.empty();
  }

  // X for the present weights, from the present X.
  bool solve(const MakeBackEnd& make_back_end) {
    ++result_.num_rounds;
    const std::unique_ptr<BackEnd> back_end = make_back_end();
    std::vector<NewFactor> factors;
    graph_.for_each([&](FactorId id, const auto& factor, const RobustKernel& kernel) {
      const auto suspect = number_of_.find(id);
      if (suspect == number_of_.end()) {
        factors.emplace_back(factor, kernel);
      } else if (const double weight = result_.weights[suspect->second]; weight > 0) {
        factors.emplace_back(factor, kernel_of_weight(weight));
      }
    });
    (void)back_end->add(std::move(factors), result_.values);
    result_.solution = back_end->solve();
    result_.num_iterations += result_.solution.num_iterations;
    if (has_failed(result_.solution.status)) return false;
    result_.values = back_end->estimate();
    return true;
  }

  // r^2 / c^2 of the suspects.
  [[nodiscard]] std::vector<double> residual_ratios() const {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < suspects_.size(); ++k) {
      ratios.push_back(graph_.chi2(suspects_[k], result_.values) / bounds_[k]);
    }
    return ratios;
  }

  [[nodiscard]] bool has_converged(double mu, double cost_before) const {
    const double cost = result_.solution.chi2;
    if (std::abs(cost_before - cost) <= params_.min_relative_decrease * cost) return true;
    if (loss_ == GncLoss::kGemanMcClure) return mu <= 1;
    return std::all_of(result_.weights.begin(), result_.weights.end(),
                       [](double weight) { return weight == 0 || weight == 1; });
  }

  GncResult finish(GncStatus status, double mu) {
    result_.status = status;
    const double at_bound = mu > 0 ? gnc_weight(loss_, 1, mu) : 0;
    for (std::size_t k = 0; k < suspects_.size(); ++k) {
      if (result_.weights[k] < at_bound) result_.rejected.push_back(suspects_[k]);
    }
    return std::move(result_);
  }

  const graph::FactorGraph& graph_;
  std::span<const FactorId> suspects_;
  GncLoss loss_;
  GncParams params_;
  std::vector<double> bounds_;                           // c^2 of the suspects
  std::unordered_map<FactorId, std::size_t> number_of_;  // among the suspects
  GncResult result_;
};

}  // namespace

RobustKernel kernel_of_weight(double weight) {
  if (weight == 1) return {};
  return {KernelKind::kScaled, std::sqrt(weight)};
}

double gnc_weight(GncLoss loss, double ratio, double mu) {
  if (loss == GncLoss::kGemanMcClure) {
    const double root = mu / (ratio + mu);
    return root * root;
  }
  if (ratio >= (mu + 1) / mu) return 0;
  if (ratio <= mu / (mu + 1)) return 1;
  return std::clamp(std::sqrt(mu * (mu + 1) / ratio) - mu, 0.0, 1.0);
}

GncResult graduated_non_convexity(const graph::FactorGraph& graph, const graph::Values& initial,
                                  std::span<const FactorId> suspects, GncLoss loss,
                                  const MakeBackEnd& make_back_end, const GncParams& params) {
  return Gnc(graph, initial, suspects, loss, params).run(make_back_end);
}

}  // namespace corridor::backend
