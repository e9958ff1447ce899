// A solver of factor graphs that can be fed step by step.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::backend {

enum class SolveStatus {
  kConverged,      // a step or the decrease of chi2 fell below its threshold
  kMaxIterations,  // stopped by the iteration limit; the estimate is usable
  // In these two the estimate is what it was before the step that failed.
  kRankDeficient,  // some variables are undetermined
  kNotFinite,      // a residual or Jacobian is not finite
  kEmpty,          // nothing to solve
};
std::string to_text(SolveStatus status);
// kRankDeficient or kNotFinite: there is no solution.
bool has_failed(SolveStatus status);

// How far update_until_converged() goes. Counts and no clock: the same input has the same answer.
struct ConvergenceBudget {
  int max_rounds = 100;
  // Share of the cost that the next step may still promise to take off; see is_small_decrement().
  double relative_decrement = 1e-9;
};

// The number of a factor that was left out.
inline constexpr graph::FactorId kNoFactor = std::numeric_limits<graph::FactorId>::max();

// Whether the Newton decrement g^T H^-1 g = delta^T H delta, the decrease of the cost that a step
// delta promises, is at most that share of the cost. It has no unit and depends neither on scales
// nor on the choice of coordinates. Decrements that rounding alone would leave are small as well.
bool is_small_decrement(double decrement, double cost, std::int64_t num_variables,
                        const ConvergenceBudget& budget);

struct BackEndReport {
  SolveStatus status = SolveStatus::kEmpty;
  int num_iterations = 0;
  // Cost after adding, before solving, and at the end. Incremental updates do not evaluate it: then
  // chi2 is what the linearised factors predict, chi2_initial not a number.
  double chi2_initial = 0;
  double chi2 = 0;
  // Decrease of the cost that the last step promised, where a back-end measures it.
  double decrement = std::numeric_limits<double>::quiet_NaN();
  std::int64_t num_factors = 0;
  std::int64_t num_variables = 0;
  std::int64_t num_relinearized = 0;       // variables moved by this update, summed over iterations
  std::int64_t num_eliminated = 0;         // variables eliminated anew, summed over iterations
  std::int64_t num_factor_nonzeros = 0;    // of the factor L; 0 where a back-end does not say
  std::optional<graph::Key> undetermined;  // with kRankDeficient: a variable that nothing holds
  std::vector<graph::FactorId> new_factor_ids;  // of `new_factors`, in order
  // Of a back-end that forgets, since its report before: new factors that were left out because
  // they name a variable that left (their number is kNoFactor), and removals that came too late.
  std::int64_t num_dropped_factors = 0;
  std::int64_t num_late_removals = 0;
  // Of isam2 and what is built on it: cliques of the tree, and memory of their fronts.
  std::int64_t num_cliques = 0;
  std::int64_t front_memory_bytes = 0;
};

class BackEnd {
 public:
  BackEnd() = default;
  BackEnd(const BackEnd&) = delete;
  BackEnd& operator=(const BackEnd&) = delete;
  virtual ~BackEnd() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  // Adds, removes, then improves the estimate. Every key of a new factor must be in `new_values` or
  // known already. A pose graph needs at least one prior.
  virtual BackEndReport update(std::vector<graph::NewFactor> new_factors,
                               const graph::Values& new_values,
                               std::span<const graph::FactorId> removed_factors) = 0;
  // Adds without solving: for systems that optimise seldom.
  virtual std::vector<graph::FactorId> add(std::vector<graph::NewFactor> new_factors,
                                           const graph::Values& new_values) = 0;
  // Solves again from the present estimate, until converged or the iteration limit.
  virtual BackEndReport solve() = 0;
  // Goes on from the present estimate until the gradient is small (kConverged) or the budget is
  // used (kMaxIterations). Plain Gauss-Newton steps may raise the cost on the way.
  virtual BackEndReport update_until_converged(const ConvergenceBudget& budget) = 0;
  // Takes known variables out for good and keeps, as a prior on their neighbours, what their
  // factors said, linearised at the present estimate. Later factors may not name them. An error
  // where a back-end does not offer it, or where a variable is not determined.
  virtual Result<void> marginalize(std::span<const graph::Key> keys);
  // Overwrites the estimate of known variables, e.g. with a front end's own.
  virtual void set_values(const graph::Values& values) = 0;

  // Reading changes no later update, but that a covariance eliminates first what was only added.
  // After a step that failed, what estimate() gave before stands; isam2's pose(), which reads one
  // pose exactly, may then differ from it by what back-substitution left out.
  [[nodiscard]] virtual const graph::Values& estimate() const = 0;
  // One pose of the estimate, for those who read the newest after every update: where a back-end
  // solves lazily, this costs no pass over all variables. Requires that the pose is known.
  [[nodiscard]] virtual Pose2 pose(std::uint32_t index) { return estimate().pose(index); }
  [[nodiscard]] virtual const graph::FactorGraph& graph() const = 0;
  // Covariance of one variable in its tangent order.
  virtual Result<Eigen::MatrixXd> marginal_covariance(graph::Key key) = 0;
};

}  // namespace corridor::backend
