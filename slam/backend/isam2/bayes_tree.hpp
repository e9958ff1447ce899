// The Bayes tree of a linearised factor graph [Kaess2012]: cliques of variables, each the Gaussian
// conditional p(frontals | separator) as rows [L11; L21; y^T] of a Cholesky factor, together with
// the update that its elimination sent to its parent. An update takes the cliques out that it
// changes, always with all cliques above them, and eliminates their variables anew; the subtrees
// below (orphans) stay as they are and enter by their updates.
//
// Variables are numbered from 0. Two things can happen to a clique: its variables or factors change
// (touch: it is taken out and planned anew), or only the numbers in its factors do, because they
// are linearised elsewhere (unsettle: it stays and is eliminated again). An update runs: touch...
// and unsettle..., open() and close() for every unsettled clique, detach(), attach(), open() and
// close() for every new clique, then solve_changed(). The tree knows of factors which variables
// they have and the caller's number; the caller sums their information into each open front. Never
// throws, never prints.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/backend/isam2/elimination_order.hpp"
#include "slam/backend/isam2/front.hpp"
#include "slam/backend/isam2/front_memory.hpp"
#include "slam/backend/isam2/variable_sets.hpp"

namespace corridor::backend {

class BayesTree {
 public:
  struct Clique {
    std::vector<int> variables;        // those eliminated here, then the separator, in order
    std::vector<std::size_t> factors;  // the caller's numbers
    int num_frontals = 0;
    int parent = kNone, first_child = kNone, next_sibling = kNone;
    bool is_touched = false;
    bool is_unsettled = false;  // its numbers are of no use any more
    bool is_solved = false;     // since it was eliminated
    // Numbers never given twice: of its making, and of its last elimination.
    std::int64_t birth = 0, elimination = 0;
    double* memory = nullptr;
    Front front;

    [[nodiscard]] std::span<const int> frontals() const {
      return std::span(variables).first(static_cast<std::size_t>(num_frontals));
    }
    [[nodiscard]] std::span<const int> separator() const {
      return std::span(variables).subspan(static_cast<std::size_t>(num_frontals));
    }
  };
  static constexpr int kNone = -1;

  // Memory that finding steps takes.
  struct Workspace {
    std::vector<double> below, z;
    std::vector<int> cliques;
  };
  // Steps of all variables one after the other, see delta_in().
  struct Solution {
    std::vector<double> deltas;
    Workspace work;
  };

  // Its number. It waits for the next detach().
  int add_variable(int dimension);
  // A variable that no factor holds any more; it must be detached. Its number is given again.
  void forget(int variable);

  // A new factor, by the caller's number; it touches its variables.
  void add_factor(std::size_t factor, std::span<const int> variables);
  // The clique that eliminates the variable, and all above, are taken out at the next detach().
  void touch(int variable);
  // Every clique that holds the variable, and all above.
  void touch_everywhere(int variable);
  // Every clique that holds the variable, and all above, wait for open() and close(): the variable
  // has another linearisation point.
  void unsettle(int variable);
  // The unsettled cliques that are not touched, children before parents. Open and close them in
  // this order before detach().
  [[nodiscard]] std::span<const int> unsettled();
  [[nodiscard]] bool has_unsettled() const { return num_unsettled_ > 0; }

  // Takes the touched cliques out.
  void detach();
  // The variables to eliminate: those of the cliques taken out and those that wait, ascending.
  [[nodiscard]] std::span<const int> detached() const { return detached_; }
  // The factors of the cliques taken out, and the new ones, in no order. Factors that the caller
  // has removed since are still among them.
  [[nodiscard]] std::span<const std::size_t> detached_factors() const { return detached_factors_; }
  // Instead of attach(): the detached variables wait for the next detach().
  void postpone() { waiting_ = detached_; }
  // Plans cliques for the detached variables. sets: the variables of each of the `factors`, all
  // among the detached ones. last: those that are eliminated last.
  void attach(const VariableSets& sets, std::span<const std::size_t> factors,
              std::span<const int> last);
  // What attach() planned, children before parents.
  [[nodiscard]] std::span<const int> new_cliques() const { return new_cliques_; }
  // The front, zero but for what its children sent.
  Front& open(int clique);
  // Scalar row, in the open front, of a variable that it holds.
  [[nodiscard]] int row_of(int variable) const { return rows_[static_cast<std::size_t>(variable)]; }
  // Eliminates the open front. False: not positive definite at first_bad_variable(). Then the
  // detached variables, or those of the open clique and all above, wait for the next detach() as
  // if nothing had been attached, with the deltas that they had.
  bool close();
  [[nodiscard]] int first_bad_variable() const { return first_bad_variable_; }

  // Solves the new cliques, and those below whose frontals would move by more than `threshold`
  // standard deviations of their conditional ("wildfire" [Kaess2012], but in these units).
  void solve_changed(double threshold);
  // Every clique, exactly.
  void solve_all();
  // Variables that either gave another delta since forget_changes(), each once.
  [[nodiscard]] std::span<const int> changed() const { return changed_; }
  void forget_changes();

  [[nodiscard]] const Solution& solution() const { return kept_; }
  // The step of a variable from its linearisation point, dimension() numbers.
  [[nodiscard]] const double* delta(int variable) const { return delta_in(kept_, variable); }
  void clear_delta(int variable);
  // Exact steps, which the tree does not keep: later updates go as if nobody had read them. Of
  // every variable, those outside the tree as they are; or of those that the cliques from the root
  // to the variable's eliminate.
  void read_all(Solution& solution) const;
  void read_path(int variable, Solution& solution) const;
  [[nodiscard]] const double* delta_in(const Solution& solution, int variable) const {
    return solution.deltas.data() + first_rows_[static_cast<std::size_t>(variable)];
  }
  [[nodiscard]] int dimension(int variable) const {
    return dimensions_[static_cast<std::size_t>(variable)];
  }
  // Sum of squares at the solution, as the linearised factors say.
  [[nodiscard]] double chi2() const;
  // Covariance of a variable that is in the tree, of the linearised factors.
  [[nodiscard]] Eigen::MatrixXd covariance(int variable) const;

  // For inspection.
  [[nodiscard]] int clique_of(int variable) const {
    return clique_of_[static_cast<std::size_t>(variable)];
  }
  [[nodiscard]] const Clique& clique(int number) const {
    return cliques_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] const std::vector<int>& roots() const { return roots_; }
  [[nodiscard]] std::size_t num_cliques() const { return cliques_.size() - free_cliques_.size(); }
  // Of the factor L, with the zeros that cliques fill.
  [[nodiscard]] std::int64_t num_nonzeros() const { return num_nonzeros_; }
  // Doubles taken for fronts, in use or not.
  [[nodiscard]] std::size_t memory_capacity() const { return memory_.capacity(); }

 private:
  Clique& at(int number) { return cliques_[static_cast<std::size_t>(number)]; }
  void touch_path(int clique);
  void unsettle_path(int clique);
  // Calls visit with every clique that holds the variable, parents before children.
  template <class Visit>
  void for_each_holder(int variable, const Visit& visit);
  int make_clique(const linear::Supernode& node);
  void hang(int child, int parent);
  void find_runs(const Clique& child, const Front& front);
  void drop(int clique);
  void find_z(const Clique& clique, Solution& solution) const;
  void substitute_back(const Clique& clique, Solution& solution) const;
  bool solve(Clique& clique, double threshold);
  Eigen::MatrixXd joint_covariance(const Clique& clique, const Eigen::MatrixXd& of_separator) const;

  std::int64_t num_nonzeros_ = 0;
  // By variable.
  std::vector<int> dimensions_, first_rows_, clique_of_, rows_;
  std::vector<int> free_variables_;
  std::vector<int> changed_in_;  // number of the pass that last gave it another delta
  std::vector<bool> is_listed_;  // among changed_
  Solution kept_;                // of the last solution, within its threshold
  // By clique.
  std::vector<Clique> cliques_;
  std::vector<int> free_cliques_, roots_;
  FrontMemory memory_;
  // Of the update under way.
  std::vector<int> touched_, detached_, waiting_, orphans_, new_cliques_, changed_, open_stack_;
  std::vector<int> unsettled_, holders_;
  std::vector<std::size_t> detached_factors_;
  VariableSets sets_;
  EliminationOrder order_;
  std::vector<RowRun> runs_;
  int open_ = kNone, first_bad_variable_ = kNone, pass_ = 0, num_unsettled_ = 0;
  std::int64_t num_births_ = 0, num_eliminations_ = 0;
};

}  // namespace corridor::backend
