// Reading the Bayes tree: back-substitution and covariances.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "slam/backend/isam2/bayes_tree.hpp"
#include "slam/core/expect.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

using Column = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

// z = y - L21^T x_s, with x_s from `solution`.
void BayesTree::find_z(const Clique& clique, Solution& solution) const {
  const Front& front = clique.front;
  const int num_pivots = front.num_pivots(), num_below = front.num_below();
  solution.work.below.clear();
  for (const int variable : clique.separator()) {
    const double* const from = delta_in(solution, variable);
    solution.work.below.insert(solution.work.below.end(), from, from + dimension(variable));
  }
  solution.work.z.resize(to_index(num_pivots));
  const Column below(solution.work.below.data(), num_below);
  for (int k = 0; k < num_pivots; ++k) {
    const double* const column = front.pivot_column(k);
    solution.work.z[to_index(k)] =
        column[front.last_row()] - Column(column + num_pivots, num_below).dot(below);
  }
}

// x_f = L11^-T z, into `solution`.
void BayesTree::substitute_back(const Clique& clique, Solution& solution) const {
  const int num_pivots = clique.front.num_pivots();
  std::vector<double>& z = solution.work.z;
  for (int k = num_pivots; k-- > 0;) {
    const double* const column = clique.front.pivot_column(k);
    double sum = z[to_index(k)];
    for (int r = k + 1; r < num_pivots; ++r) sum -= column[r] * z[to_index(r)];
    z[to_index(k)] = sum * column[k];
  }
  const double* from = z.data();
  for (const int variable : clique.frontals()) {
    std::copy_n(from, dimension(variable),
                solution.deltas.data() + first_rows_[to_index(variable)]);
    from += dimension(variable);
  }
}

// False, and nothing done, if z is within `threshold` of what it was at the last solution.
bool BayesTree::solve(Clique& clique, double threshold) {
  find_z(clique, kept_);
  double* const kept_z = clique.front.kept_z();
  const auto is_far = [&](double z, double kept) {
    return !(std::abs(z - kept) <= threshold);  // also if either is not a number
  };
  if (clique.is_solved &&
      std::equal(kept_.work.z.begin(), kept_.work.z.end(), kept_z, std::not_fn(is_far))) {
    return false;
  }
  clique.is_solved = true;
  std::copy(kept_.work.z.begin(), kept_.work.z.end(), kept_z);
  substitute_back(clique, kept_);
  for (const int variable : clique.frontals()) {
    changed_in_[to_index(variable)] = pass_;
    if (!is_listed_[to_index(variable)]) changed_.push_back(variable);
    is_listed_[to_index(variable)] = true;
  }
  return true;
}

void BayesTree::solve_changed(double threshold) {
  ++pass_;
  kept_.work.cliques = roots_;
  while (!kept_.work.cliques.empty()) {
    Clique& clique = at(kept_.work.cliques.back());
    kept_.work.cliques.pop_back();
    const bool is_below_changed = std::ranges::any_of(
        clique.separator(), [&](int v) { return changed_in_[to_index(v)] == pass_; });
    const bool is_due = is_below_changed || !clique.is_solved || threshold < 0;
    const bool is_changed = is_due && solve(clique, threshold);
    if (!is_changed && !is_below_changed) continue;
    for (int child = clique.first_child; child != kNone; child = at(child).next_sibling) {
      kept_.work.cliques.push_back(child);
    }
  }
}

void BayesTree::forget_changes() {
  for (const int variable : changed_) is_listed_[to_index(variable)] = false;
  changed_.clear();
}

void BayesTree::solve_all() { solve_changed(-1); }

void BayesTree::read_all(Solution& solution) const {
  solution.deltas = kept_.deltas;
  solution.work.cliques = roots_;
  while (!solution.work.cliques.empty()) {
    const Clique& above = clique(solution.work.cliques.back());
    solution.work.cliques.pop_back();
    find_z(above, solution);
    substitute_back(above, solution);
    for (int child = above.first_child; child != kNone; child = clique(child).next_sibling) {
      solution.work.cliques.push_back(child);
    }
  }
}

void BayesTree::read_path(int variable, Solution& solution) const {
  solution.deltas.resize(kept_.deltas.size());
  solution.work.cliques.clear();
  for (int number = clique_of(variable); number != kNone; number = clique(number).parent) {
    solution.work.cliques.push_back(number);
  }
  while (!solution.work.cliques.empty()) {
    const Clique& above = clique(solution.work.cliques.back());
    solution.work.cliques.pop_back();
    find_z(above, solution);
    substitute_back(above, solution);
  }
}

// Of the clique's variables in their order, from that of its separator: [Kaess2009] section 3,
// clique by clique instead of entry by entry.
Eigen::MatrixXd BayesTree::joint_covariance(const Clique& clique,
                                            const Eigen::MatrixXd& of_separator) const {
  const int p = clique.front.num_pivots(), b = clique.front.num_below();
  Eigen::MatrixXd L(p + b, p);
  for (int k = 0; k < p; ++k) {
    L.col(k) = Column(clique.front.pivot_column(k), p + b);
    L(k, k) = 1 / L(k, k);
  }
  const auto L11 = L.topRows(p).triangularView<Eigen::Lower>();
  const Eigen::MatrixXd inverse = L11.solve(Eigen::MatrixXd::Identity(p, p));
  const Eigen::MatrixXd by_separator = -inverse.transpose() * L.bottomRows(b).transpose();
  Eigen::MatrixXd joint(p + b, p + b);
  joint.bottomRightCorner(b, b) = of_separator;
  joint.topRightCorner(p, b) = by_separator * of_separator;
  joint.bottomLeftCorner(b, p) = joint.topRightCorner(p, b).transpose();
  joint.topLeftCorner(p, p) =
      inverse.transpose() * inverse + joint.topRightCorner(p, b) * by_separator.transpose();
  return joint;
}

Eigen::MatrixXd BayesTree::covariance(int variable) const {
  CORRIDOR_EXPECT(clique_of(variable) != kNone);
  std::vector<int> path;
  for (int number = clique_of(variable); number != kNone; number = clique(number).parent) {
    path.push_back(number);
  }
  Eigen::MatrixXd joint;
  const Clique* above = nullptr;
  std::vector<int> rows;
  const auto rows_in = [&](const Clique& holder, int wanted) {
    int row = 0;
    for (const int other : holder.variables) {
      if (other == wanted) break;
      row += dimension(other);
    }
    for (int d = 0; d < dimension(wanted); ++d) rows.push_back(row + d);
  };
  for (auto number = path.rbegin(); number != path.rend(); ++number) {
    rows.clear();
    for (const int other : clique(*number).separator()) rows_in(*above, other);
    joint = joint_covariance(clique(*number), Eigen::MatrixXd(joint(rows, rows)));
    above = &clique(*number);
  }
  rows.clear();
  rows_in(*above, variable);
  return joint(rows, rows);
}

}  // namespace corridor::backend
