#include "slam/backend/isam2/bayes_tree.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::backend {
namespace {

// Solutions are compared on problems whose condition is at most some 1e4.
constexpr double kSameSolution = 1e-9;

struct LinearFactor {
  std::vector<int> variables;
  Eigen::MatrixXd J;
  Eigen::VectorXd r;
};

// A random linear problem beside its tree, changed step by step.
class LinearProblem {
 public:
  explicit LinearProblem(std::uint64_t seed) : rng_(seed) {}

  BayesTree& tree() { return tree_; }
  Rng& rng() { return rng_; }
  [[nodiscard]] const std::map<std::size_t, LinearFactor>& factors() const { return factors_; }
  [[nodiscard]] int num_variables() const { return static_cast<int>(first_rows_.size()); }

  // A variable that a prior holds, tied to a few earlier ones.
  void grow() {
    const int dimension = static_cast<int>(rng_.uniform(1, 4));
    const int variable = tree_.add_variable(dimension);
    first_rows_.push_back(num_rows_);
    num_rows_ += dimension;
    add_factor({variable});
    for (int k = 0; k < 2 && variable > 0; ++k) tie(variable, random_variable());
  }
  void tie(int a, int b) {
    if (a != b) add_factor({a, b});
  }
  // Takes out a factor that is not a prior.
  void loosen() {
    std::vector<std::size_t> ties;
    for (const auto& [id, factor] : factors_) {
      if (factor.variables.size() > 1) ties.push_back(id);
    }
    if (ties.empty()) return;
    const std::size_t id = ties[static_cast<std::size_t>(rng_.uniform(0, 1) * 0.999 *
                                                         static_cast<double>(ties.size()))];
    for (const int variable : factors_.at(id).variables) tree_.touch(variable);
    factors_.erase(id);
  }
  int random_variable() { return static_cast<int>(rng_.uniform(0, 0.999) * num_variables()); }
  void add_factor(const std::vector<int>& variables) {
    int num_columns = 0;
    for (const int variable : variables) num_columns += tree_.dimension(variable);
    LinearFactor factor{variables, Eigen::MatrixXd(num_columns, num_columns),
                        Eigen::VectorXd(num_columns)};
    draw(factor);
    tree_.add_factor(next_id_, variables);
    factors_.emplace(next_id_++, std::move(factor));
  }

  // Other numbers in all factors of a variable, as if they were linearised elsewhere.
  void restate(int variable) {
    for (auto& [id, factor] : factors_) {
      if (std::ranges::count(factor.variables, variable) == 0) continue;
      draw(factor);
    }
    tree_.unsettle(variable);
  }
  void set_factors(const std::map<std::size_t, LinearFactor>& factors) { factors_ = factors; }
  // No factor says anything about the variable: it is undetermined.
  void silence(int variable) {
    for (auto& [id, factor] : factors_) {
      if (std::ranges::count(factor.variables, variable) == 1) factor.J.setZero();
    }
  }

  bool eliminate(std::size_t num_last = 1) {
    if (!eliminate_each(tree_.unsettled())) return false;
    tree_.detach();
    VariableSets sets;
    std::vector<std::size_t> ids;
    for (const std::size_t id : tree_.detached_factors()) {
      if (factors_.count(id) == 0) continue;
      ids.push_back(id);
      sets.add(factors_.at(id).variables);
    }
    const auto detached = tree_.detached();
    tree_.attach(sets, ids, detached.last(std::min(num_last, detached.size())));
    return eliminate_each(tree_.new_cliques());
  }

  // Dense information matrix and gradient.
  [[nodiscard]] Eigen::MatrixXd information() const {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(num_rows_, num_rows_);
    for (const auto& [id, factor] : factors_) {
      const Eigen::MatrixXd wide = spread(factor);
      H += wide.transpose() * wide;
    }
    return H;
  }
  [[nodiscard]] Eigen::VectorXd solution() const {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(num_rows_);
    for (const auto& [id, factor] : factors_) g += spread(factor).transpose() * factor.r;
    return -information().ldlt().solve(g);
  }
  [[nodiscard]] double chi2_at(const Eigen::VectorXd& x) const {
    double sum = 0;
    for (const auto& [id, factor] : factors_) sum += (factor.r + spread(factor) * x).squaredNorm();
    return sum;
  }
  [[nodiscard]] Eigen::VectorXd deltas() const {
    Eigen::VectorXd x(num_rows_);
    for (int v = 0; v < num_variables(); ++v) {
      for (int d = 0; d < tree_.dimension(v); ++d) x(row_of(v) + d) = tree_.delta(v)[d];
    }
    return x;
  }
  [[nodiscard]] int row_of(int variable) const {
    return first_rows_[static_cast<std::size_t>(variable)];
  }

 private:
  [[nodiscard]] Eigen::MatrixXd spread(const LinearFactor& factor) const {
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(factor.J.rows(), num_rows_);
    Eigen::Index column = 0;
    for (const int variable : factor.variables) {
      const int dimension = tree_.dimension(variable);
      wide.middleCols(row_of(variable), dimension) = factor.J.middleCols(column, dimension);
      column += dimension;
    }
    return wide;
  }
  void add(const LinearFactor& factor, Front& front) {
    Eigen::Index column_a = 0;
    front.add_chi2(factor.r.squaredNorm());
    for (const int a : factor.variables) {
      const auto J_a = factor.J.middleCols(column_a, tree_.dimension(a));
      front.add_gradient(tree_.row_of(a), (J_a.transpose() * factor.r).eval());
      Eigen::Index column_b = 0;
      for (const int b : factor.variables) {
        const auto J_b = factor.J.middleCols(column_b, tree_.dimension(b));
        front.add(tree_.row_of(a), tree_.row_of(b), (J_a.transpose() * J_b).eval());
        column_b += tree_.dimension(b);
        if (b == a) break;
      }
      column_a += tree_.dimension(a);
    }
  }

  void draw(LinearFactor& factor) {
    for (double& entry : factor.J.reshaped()) entry = rng_.normal();
    for (double& entry : factor.r) entry = rng_.normal();
    factor.J.diagonal().array() += 3;
  }
  bool eliminate_each(std::span<const int> cliques) {
    for (const int clique : cliques) {
      Front& front = tree_.open(clique);
      for (const std::size_t id : tree_.clique(clique).factors) add(factors_.at(id), front);
      if (!tree_.close()) return false;
    }
    return true;
  }

  Rng rng_;
  BayesTree tree_;
  std::map<std::size_t, LinearFactor> factors_;
  std::vector<int> first_rows_;
  int num_rows_ = 0;
  std::size_t next_id_ = 0;
};

// Adds, ties, removes or re-eliminates, and brings the tree up to date.
void random_step(LinearProblem& problem) {
  const double dice = problem.rng().uniform(0, 1);
  if (dice < 0.5 || problem.num_variables() < 2) {
    problem.grow();
  } else if (dice < 0.7) {
    problem.tie(problem.random_variable(), problem.random_variable());
  } else if (dice < 0.85) {
    problem.loosen();
  } else if (dice < 0.9) {
    problem.tree().touch_everywhere(problem.random_variable());
  } else {
    problem.grow();
    for (int k = 0; k < 3; ++k) problem.restate(problem.random_variable());
  }
}

RC_GTEST_PROP(BayesTree, EqualsTheBatchSolutionAfterEveryRandomUpdate, (std::uint64_t seed)) {
  LinearProblem problem(seed);
  for (int step = 0; step < 40; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate(1 + static_cast<std::size_t>(step % 4)));
    problem.tree().solve_changed(0);
    const Eigen::VectorXd expected = problem.solution();
    RC_ASSERT((problem.deltas() - expected).norm() <= kSameSolution * (1 + expected.norm()));
    RC_ASSERT(std::abs(problem.tree().chi2() - problem.chi2_at(expected)) <=
              kSameSolution * (1 + problem.chi2_at(expected)));
  }
}

RC_GTEST_PROP(BayesTree, KeepsItsInvariantsAfterEveryRandomUpdate, (std::uint64_t seed)) {
  LinearProblem problem(seed);
  for (int step = 0; step < 40; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
    const BayesTree& tree = problem.tree();
    std::set<int> cliques;
    for (int v = 0; v < problem.num_variables(); ++v) cliques.insert(tree.clique_of(v));
    std::size_t num_frontals = 0;
    for (const int number : cliques) {
      const BayesTree::Clique& clique = tree.clique(number);
      num_frontals += clique.frontals().size();
      for (const int v : clique.frontals()) RC_ASSERT(tree.clique_of(v) == number);
      RC_ASSERT((clique.parent < 0) == clique.separator().empty());
      if (clique.parent < 0) {
        RC_ASSERT(std::ranges::count(tree.roots(), number) == 1);
        continue;
      }
      // Running intersection: what a child shares with the rest, its parent holds.
      const auto& above = tree.clique(clique.parent).variables;
      for (const int v : clique.separator()) RC_ASSERT(std::ranges::count(above, v) == 1);
      int num_times = 0;
      for (int c = tree.clique(clique.parent).first_child; c >= 0;
           c = tree.clique(c).next_sibling) {
        num_times += c == number ? 1 : 0;
      }
      RC_ASSERT(num_times == 1);
    }
    RC_ASSERT(num_frontals == static_cast<std::size_t>(problem.num_variables()));
    // The variables of a factor lie on one way to the root: in the clique of the first of them.
    for (const auto& [id, factor] : problem.factors()) {
      const bool is_held = std::ranges::any_of(factor.variables, [&](int first) {
        const auto& held = tree.clique(tree.clique_of(first)).variables;
        return std::ranges::all_of(factor.variables,
                                   [&](int v) { return std::ranges::count(held, v) == 1; });
      });
      RC_ASSERT(is_held);
    }
  }
}

RC_GTEST_PROP(BayesTree, KeepsTheCliquesInWhichOnlyNumbersChange, (std::uint64_t seed)) {
  LinearProblem problem(seed);
  for (int step = 0; step < 30; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
  }
  const auto cliques = [&problem] {
    std::vector<std::vector<int>> all;
    for (int v = 0; v < problem.num_variables(); ++v) {
      all.push_back(problem.tree().clique(problem.tree().clique_of(v)).variables);
    }
    return all;
  };
  const auto before = cliques();
  problem.restate(problem.random_variable());
  RC_ASSERT(problem.tree().has_unsettled());
  RC_ASSERT(problem.eliminate());
  RC_ASSERT(!problem.tree().has_unsettled());
  RC_ASSERT(cliques() == before);
}

RC_GTEST_PROP(BayesTree, HealsOnceWhatMadeItSingularIsGone, (std::uint64_t seed)) {
  LinearProblem problem(seed);
  for (int step = 0; step < 20; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
  }
  const auto good = problem.factors();
  const int variable = problem.random_variable();
  problem.silence(variable);
  problem.tree().unsettle(variable);
  RC_ASSERT(!problem.eliminate());
  problem.set_factors(good);
  problem.tree().unsettle(variable);
  RC_ASSERT(problem.eliminate());
  problem.tree().solve_changed(0);
  const Eigen::VectorXd expected = problem.solution();
  RC_ASSERT((problem.deltas() - expected).norm() <= kSameSolution * (1 + expected.norm()));
}

RC_GTEST_PROP(BayesTree, CovariancesAreTheBlocksOfTheDenseInverse, (std::uint64_t seed)) {
  LinearProblem problem(seed);
  for (int step = 0; step < 25; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
  }
  const Eigen::MatrixXd inverse = problem.information().inverse();
  for (int v = 0; v < problem.num_variables(); ++v) {
    const int row = problem.row_of(v), d = problem.tree().dimension(v);
    const Eigen::MatrixXd expected = inverse.block(row, row, d, d);
    RC_ASSERT((problem.tree().covariance(v) - expected).norm() <= kSameSolution * expected.norm());
  }
}

RC_GTEST_PROP(BayesTree, WhatIsReadIsExactAndChangesNothing, (std::uint64_t seed)) {
  constexpr double kCoarse = 0.5;
  LinearProblem problem(seed);
  const auto read_delta = [&](const BayesTree::Solution& read, int variable) {
    const double* const from = problem.tree().delta_in(read, variable);
    return Eigen::VectorXd(Eigen::VectorXd::Map(from, problem.tree().dimension(variable)));
  };
  BayesTree::Solution all, path;
  for (int step = 0; step < 30; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
    problem.tree().solve_changed(kCoarse);
    const Eigen::VectorXd kept = problem.deltas(), expected = problem.solution();
    problem.tree().read_all(all);
    const int wanted = problem.random_variable();
    problem.tree().read_path(wanted, path);
    RC_ASSERT(read_delta(path, wanted) == read_delta(all, wanted));
    for (int v = 0; v < problem.num_variables(); ++v) {
      const auto exact = expected.segment(problem.row_of(v), problem.tree().dimension(v));
      RC_ASSERT((read_delta(all, v) - exact).norm() <= kSameSolution * (1 + expected.norm()));
    }
    RC_ASSERT(problem.deltas() == kept);
    problem.tree().solve_changed(kCoarse);
    RC_ASSERT(problem.deltas() == kept);
  }
}

// Each whitened row is within the threshold, so that all of them are within its share of
// sqrt(rows).
RC_GTEST_PROP(BayesTree, WildfireLeavesNoRowFurtherOffThanItsThreshold, (std::uint64_t seed)) {
  constexpr double kThreshold = 0.05;
  LinearProblem problem(seed);
  for (int step = 0; step < 40; ++step) {
    random_step(problem);
    RC_ASSERT(problem.eliminate());
    problem.tree().solve_changed(kThreshold);
    const Eigen::VectorXd error = problem.deltas() - problem.solution();
    RC_ASSERT(std::sqrt(error.dot(problem.information() * error)) <=
              kThreshold * std::sqrt(static_cast<double>(error.rows())));
  }
}

TEST(BayesTree, AVariableThatNothingHoldsIsNamedAndTheRestCanGoOn) {
  LinearProblem problem(3);
  for (int k = 0; k < 8; ++k) problem.grow();
  ASSERT_TRUE(problem.eliminate());
  problem.tree().solve_changed(0);
  const Eigen::VectorXd before = problem.deltas();
  const int loose = problem.tree().add_variable(2);
  EXPECT_FALSE(problem.eliminate());
  EXPECT_EQ(problem.tree().first_bad_variable(), loose);
  problem.tree().forget(loose);
  EXPECT_TRUE(problem.eliminate());
  problem.tree().solve_changed(0);
  EXPECT_LT((problem.deltas() - before).norm(), kSameSolution);
}

}  // namespace
}  // namespace corridor::backend
