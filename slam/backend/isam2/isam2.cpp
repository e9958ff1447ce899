#include "slam/backend/isam2/isam2.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "slam/backend/isam2/bayes_tree.hpp"
#include "slam/backend/isam2/linear_terms.hpp"
#include "slam/backend/isam2/marginalization.hpp"
#include "slam/backend/isam2/tree_snapshot.hpp"
#include "slam/core/expect.hpp"
#include "slam/graph/slot_range.hpp"
#include "slam/graph/variable_index.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

using graph::FactorId;
using graph::Key;
using graph::NewFactor;
using graph::Values;

class Isam2 final : public BackEnd {
 public:
  explicit Isam2(const Isam2Params& params)
      : params_(params),
        squared_threshold_{square(params.relinearize_pose), square(params.relinearize_velocity),
                           square(params.relinearize_bias),
                           square(params.relinearize_wheel_calibration)} {}

  std::string_view name() const override { return "isam2"; }

  std::vector<FactorId> add(std::vector<NewFactor> new_factors, const Values& new_values) override {
    for (const Key key : new_values.keys()) add_variable(key);
    linearization_.merge(new_values);
    if (is_estimate_current_) estimate_.merge(new_values);
    std::vector<FactorId> ids;
    for (NewFactor& factor : new_factors) ids.push_back(add_factor(std::move(factor)));
    return ids;
  }

  BackEndReport update(std::vector<NewFactor> new_factors, const Values& new_values,
                       std::span<const FactorId> removed_factors) override {
    for (const FactorId id : removed_factors) remove_factor(id);
    BackEndReport report;
    report.new_factor_ids = add(std::move(new_factors), new_values);
    report.chi2_initial = std::numeric_limits<double>::quiet_NaN();
    if (graph_.num_factors() == 0) return finished(report);
    do {
      relinearize(report);
      if (!eliminate(report)) return finished(report);
      is_frozen_ = is_estimate_current_ = false;
      tree_.solve_changed(params_.wildfire);
      mark_far_steps();
      ++report.num_iterations;
    } while (report.num_iterations < params_.max_rounds &&
             largest_step_ > square(params_.repeat_step));
    report.status = marked_.empty() ? SolveStatus::kConverged : SolveStatus::kMaxIterations;
    report.chi2 = tree_.chi2();
    return finished(report);
  }

  BackEndReport solve() override {
    return update_until_converged({params_.max_iterations, params_.min_relative_decrease});
  }

  BackEndReport update_until_converged(const ConvergenceBudget& budget) override {
    BackEndReport report;
    if (graph_.num_factors() == 0) return finished(report);
    if (!is_frozen_) settle();
    const Values before_all = estimate();
    if (is_frozen_) settle();
    report.chi2 = report.chi2_initial = graph_.cost(estimate_);
    report.status = SolveStatus::kMaxIterations;
    const auto num_variables = static_cast<std::int64_t>(linearization_.size());
    while (report.num_iterations < budget.max_rounds && take_full_step(report)) {
      if (!is_small_decrement(report.decrement, report.chi2, num_variables, budget)) continue;
      report.status = SolveStatus::kConverged;
      break;
    }
    if (!std::isfinite(report.chi2)) report.status = SolveStatus::kNotFinite;
    if (has_failed(report.status)) set_values(before_all);
    return finished(report);
  }

  void set_values(const Values& values) override {
    if (!is_frozen_) tree_.solve_all();
    for (const Key key : values.keys()) move_to_another_point(index_.of(key));
    linearization_.merge(values);
    if (is_estimate_current_) estimate_.merge(values);
  }

  Result<void> marginalize(std::span<const Key> named) override {
    const std::set<Key> unique(named.begin(), named.end());
    const std::vector<Key> keys(unique.begin(), unique.end());
    std::set<FactorId> held;
    for (const Key key : keys) {
      if (!index_.contains(key)) return unknown(key, "marginalisation");
      const auto& ids = factors_of_[to_index(index_.of(key))];
      held.insert(ids.begin(), ids.end());
    }
    const std::vector<FactorId> removed(held.begin(), held.end());
    const auto prior = marginal_prior(graph_, estimate(), removed, keys);
    if (!prior) return tl::make_unexpected(prior.error());
    for (const Key key : keys) tree_.touch_everywhere(index_.of(key));
    for (const FactorId id : removed) remove_factor(id);
    tree_.detach();
    is_frozen_ = true;
    for (const Key key : keys) forget(key);
    tree_.postpone();
    if (*prior) add_factor(**prior);
    return {};
  }

  const Values& estimate() const override {
    if (!is_estimate_current_) {
      if (!is_frozen_) tree_.read_all(read_);
      gather(is_frozen_ ? tree_.solution() : read_);
    }
    return estimate_;
  }

  Pose2 pose(std::uint32_t index) override {
    if (is_estimate_current_) return estimate_.pose(index);
    const int variable = index_.of(graph::pose_key(index));
    const bool is_path_due = tree_.clique_of(variable) != BayesTree::kNone && !is_frozen_;
    if (is_path_due) tree_.read_path(variable, read_);
    const double* const delta = tree_.delta_in(is_path_due ? read_ : tree_.solution(), variable);
    return linearization_.pose(index).plus({delta[0], delta[1], delta[2]});
  }

  const graph::FactorGraph& graph() const override { return graph_; }
  TreeSnapshot tree() const { return snapshot_of(tree_, index_.keys()); }

  Result<Eigen::MatrixXd> marginal_covariance(Key key) override {
    if (!index_.contains(key)) return unknown(key, "marginal covariance");
    BackEndReport report;
    if (!eliminate(report)) {
      const std::string where = report.undetermined
                                    ? "singular at " + graph::to_text(*report.undetermined)
                                    : "not finite";
      return fail(ErrorCode::kInvalid, "the normal equations are " + where, "marginal covariance",
                  "a prior and factors that determine every variable");
    }
    return tree_.covariance(index_.of(key));
  }

 private:
  static double square(double x) { return x * x; }
  static tl::unexpected<Error> unknown(Key key, const char* task) {
    return fail(ErrorCode::kNotFound, "no variable " + graph::to_text(key), task);
  }

  void add_variable(Key key) {
    if (index_.contains(key)) {
      move_to_another_point(index_.of(key));
      return;
    }
    const int variable = tree_.add_variable(key.dimension());
    index_.add(key, variable);
    if (to_index(variable) >= factors_of_.size()) {
      factors_of_.resize(to_index(variable) + 1);
      is_marked_.resize(to_index(variable) + 1, false);
      birth_of_.resize(to_index(variable) + 1);
    }
    information_.add_variable(variable, key.dimension());
    birth_of_[to_index(variable)] = num_births_++;
  }

  FactorId add_factor(NewFactor factor) {
    variables_.clear();
    for (const Key key : keys_of(factor.factor)) {
      CORRIDOR_EXPECT(index_.contains(key));
      variables_.push_back(index_.of(key));
    }
    has_kernels_ = has_kernels_ || factor.kernel.kind != graph::KernelKind::kNone;
    const FactorId id = graph_.add(std::move(factor));
    variables_of_.set(id, variables_);
    tree_.add_factor(id, variables_);
    for (const int variable : variables_) {
      factors_of_[to_index(variable)].push_back(id);
      if (information_.state(variable) != InformationTable::State::kKnown) continue;
      add_information(graph_, id, linearization_, index_.keys()[to_index(variable)],
                      information_.H(variable));
    }
    return id;
  }

  void forget(Key key) {
    const int variable = index_.of(key);
    if (is_marked_[to_index(variable)]) std::erase(marked_, variable);
    is_marked_[to_index(variable)] = false;
    tree_.forget(variable);
    index_.remove(key);
    linearization_.erase(key);
    estimate_.erase(key);
  }

  void remove_factor(FactorId id) {
    graph_.remove(id);
    for (const int variable : variables_of_[id]) {
      std::erase(factors_of_[to_index(variable)], id);
      tree_.touch(variable);
      information_.forget(variable);
    }
    variables_of_.erase(id);
  }

  void mark(int variable) {
    if (is_marked_[to_index(variable)]) return;
    is_marked_[to_index(variable)] = true;
    marked_.push_back(variable);
  }

  // Moves the linearisation point of every marked variable to its estimate.
  void relinearize(BackEndReport& report) {
    for (const int variable : marked_) {
      is_marked_[to_index(variable)] = false;
      linearization_.retract(index_.keys()[to_index(variable)], tree_.delta(variable));
      move_to_another_point(variable);
      information_.begin_sum(variable);  // all its factors are linearised now
    }
    report.num_relinearized += static_cast<std::int64_t>(marked_.size());
    marked_.clear();
  }

  void gather(const BayesTree::Solution& steps) const {
    estimate_ = linearization_;
    for (const Key key : linearization_.keys()) {
      estimate_.retract(key, tree_.delta_in(steps, index_.of(key)));
    }
    is_estimate_current_ = true;
  }

  // The tree's own steps become those that are read; frozen ones stay what they are.
  void settle() {
    if (!is_frozen_) tree_.solve_all();
    gather(tree_.solution());
  }

  // One Gauss-Newton step of all variables, from a settled tree to one; false where there is none.
  bool take_full_step(BackEndReport& report) {
    if (!std::isfinite(report.chi2)) return false;
    for (const Key key : linearization_.keys()) mark(index_.of(key));
    relinearize(report);
    if (!eliminate(report)) return false;
    is_frozen_ = false;
    report.decrement = report.chi2 - tree_.chi2();
    settle();
    report.chi2 = graph_.cost(estimate_);
    ++report.num_iterations;
    return true;
  }

  void move_to_another_point(int variable) {
    is_frozen_ = true;
    tree_.clear_delta(variable);
    tree_.unsettle(variable);
    information_.forget(variable);
    // Its neighbours' information changes little, unless a kernel weighs a factor differently.
    if (!has_kernels_) return;
    for (const FactorId id : factors_of_[to_index(variable)]) {
      if (graph_.kernel(id).kind == graph::KernelKind::kNone) continue;
      for (const int other : variables_of_[id]) information_.forget(other);
    }
  }

  // The factors of the cliques taken out and the new ones, but for those removed since.
  void collect_factors() {
    collected_.clear();
    std::copy_if(tree_.detached_factors().begin(), tree_.detached_factors().end(),
                 std::back_inserter(collected_),
                 [this](FactorId id) { return graph_.contains(id); });
    std::sort(collected_.begin(), collected_.end());
    sets_.clear();
    for (const FactorId id : collected_) sets_.add(variables_of_[id]);
  }

  // False: rank deficient, and the report says where, or not finite.
  bool eliminate(BackEndReport& report) {
    is_frozen_ = is_frozen_ || tree_.has_unsettled();
    bool is_good = eliminate_each(tree_.unsettled(), report);
    if (is_good) {
      tree_.detach();
      if (!tree_.detached().empty()) {
        is_frozen_ = true;
        collect_factors();
        newest_.assign(tree_.detached().begin(), tree_.detached().end());
        tree_.attach(sets_, collected_, last_born(newest_, birth_of_, params_.num_last));
        is_good = eliminate_each(tree_.new_cliques(), report);
      }
    }
    if (is_good && !std::isfinite(tree_.chi2())) report.status = SolveStatus::kNotFinite;
    is_good = is_good && !has_failed(report.status);
    information_.end_sums(is_good);
    return is_good;
  }

  bool eliminate_each(std::span<const int> cliques, BackEndReport& report) {
    for (const int number : cliques) {
      Front& front = tree_.open(number);
      const BayesTree::Clique& clique = tree_.clique(number);
      report.num_eliminated += clique.num_frontals;
      for (const FactorId id : clique.factors) {
        add_linearized(graph_, id, linearization_, variables_of_[id], tree_, front, information_);
      }
      if (tree_.close()) continue;
      // What is no number has no good pivot either.
      report.status = std::isfinite(graph_.cost(linearization_)) ? SolveStatus::kRankDeficient
                                                                 : SolveStatus::kNotFinite;
      if (report.status == SolveStatus::kRankDeficient) {
        report.undetermined = index_.keys()[to_index(tree_.first_bad_variable())];
      }
      return false;
    }
    return true;
  }

  // Marks the variables whose new step is too long for their linearisation.
  void mark_far_steps() {
    largest_step_ = 0;
    for (const int variable : tree_.changed()) {
      const double step = squared_step(variable);
      largest_step_ = std::max(largest_step_, step);
      const auto kind = static_cast<std::size_t>(index_.keys()[to_index(variable)].kind);
      if (step > squared_threshold_[kind]) mark(variable);
    }
    tree_.forget_changes();
  }

  // Of delta, in standard deviations.
  double squared_step(int variable) {
    if (information_.state(variable) == InformationTable::State::kUnknown) {
      information_.reset(variable);
      for (const FactorId id : factors_of_[to_index(variable)]) {
        add_information(graph_, id, linearization_, index_.keys()[to_index(variable)],
                        information_.H(variable));
      }
    }
    return information_.squared_length(variable, index_.keys()[to_index(variable)].kind,
                                       tree_.delta(variable));
  }

  BackEndReport finished(BackEndReport& report) {
    report.num_factors = static_cast<std::int64_t>(graph_.num_factors());
    report.num_variables = static_cast<std::int64_t>(linearization_.size());
    report.num_factor_nonzeros = tree_.num_nonzeros();
    report.num_cliques = static_cast<std::int64_t>(tree_.num_cliques());
    report.front_memory_bytes = static_cast<std::int64_t>(tree_.memory_capacity() * sizeof(double));
    return std::move(report);
  }

  Isam2Params params_;
  std::array<double, graph::kNumVariableKinds> squared_threshold_;
  graph::FactorGraph graph_;
  Values linearization_;
  graph::VariableIndex index_;
  BayesTree tree_;
  mutable BayesTree::Solution read_;  // exactly; the tree itself solves what moves far enough
  mutable Values estimate_;
  mutable bool is_estimate_current_ = true;
  // The tree is ahead of the estimate: variables were moved or eliminated, and not all solved
  // since.
  bool is_frozen_ = false;
  bool has_kernels_ = false;  // any factor so far
  // By variable.
  std::vector<std::vector<FactorId>> factors_of_;
  InformationTable information_;
  std::vector<bool> is_marked_;
  std::vector<std::int64_t> birth_of_;  // when it came, counted in variables
  std::int64_t num_births_ = 0;
  std::vector<int> marked_;
  double largest_step_ = 0;
  // By factor.
  graph::SlotRange<std::vector<int>> variables_of_;
  // Of the update under way.
  std::vector<FactorId> collected_;
  VariableSets sets_;
  std::vector<int> variables_, newest_;
};

}  // namespace

std::unique_ptr<BackEnd> make_isam2(const Isam2Params& params) {
  return std::make_unique<Isam2>(params);
}

std::optional<TreeSnapshot> tree_of(const BackEnd& back_end) {
  const auto* const isam2 = dynamic_cast<const Isam2*>(&back_end);
  return isam2 == nullptr ? std::nullopt : std::optional(isam2->tree());
}

}  // namespace corridor::backend
