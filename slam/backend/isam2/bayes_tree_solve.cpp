// Reading the Bayes tree: back-substitution and covariances.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/backend/isam2/bayes_tree.hpp"
#include "slam/core/expect.hpp"

namespace corridor::backend {
using linear::to_index;

namespace {

using Column = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

// x_f = L11^-T (y - L21^T x_s). is_changed: false if z = y - L21^T x_s is within `threshold` of
// what it was at the last solution, so that nothing was done.
void BayesTree::solve(Clique& clique, double threshold, bool& is_changed) {
  Front& front = clique.front;
  const int num_pivots = front.num_pivots(), num_below = front.num_below();
  below_.clear();
  for (const int variable : clique.separator()) {
    const double* const from = delta(variable);
    below_.insert(below_.end(), from, from + dimension(variable));
  }
  z_.resize(to_index(num_pivots));
  const Column below(below_.data(), num_below);
  bool is_far = false;
  for (int k = 0; k < num_pivots; ++k) {
    const double* const column = front.pivot_column(k);
    z_[to_index(k)] = column[front.last_row()] - Column(column + num_pivots, num_below).dot(below);
    // Also if either is not a number.
    is_far = is_far || !(std::abs(z_[to_index(k)] - front.kept_z()[k]) <= threshold);
  }
  is_changed = !clique.is_solved || is_far;
  if (!is_changed) return;
  clique.is_solved = true;
  std::copy(z_.begin(), z_.end(), front.kept_z());
  for (int k = num_pivots; k-- > 0;) {
    const double* const column = front.pivot_column(k);
    double sum = z_[to_index(k)];
    for (int r = k + 1; r < num_pivots; ++r) sum -= column[r] * z_[to_index(r)];
    z_[to_index(k)] = sum * column[k];
  }
  const double* from = z_.data();
  for (const int variable : clique.frontals()) {
    std::copy_n(from, dimension(variable), deltas_.data() + first_rows_[to_index(variable)]);
    from += dimension(variable);
    changed_in_[to_index(variable)] = pass_;
    if (!is_listed_[to_index(variable)]) changed_.push_back(variable);
    is_listed_[to_index(variable)] = true;
  }
}

void BayesTree::solve_changed(double threshold) {
  ++pass_;
  open_stack_ = roots_;
  while (!open_stack_.empty()) {
    Clique& clique = at(open_stack_.back());
    open_stack_.pop_back();
    const bool is_below_changed = std::ranges::any_of(
        clique.separator(), [&](int v) { return changed_in_[to_index(v)] == pass_; });
    bool is_changed = false;
    if (is_below_changed || !clique.is_solved || threshold < 0)
      solve(clique, threshold, is_changed);
    if (!is_changed && !is_below_changed && !clique.are_children_due) continue;
    clique.are_children_due = false;
    for (int child = clique.first_child; child != kNone; child = at(child).next_sibling) {
      open_stack_.push_back(child);
    }
  }
}

void BayesTree::forget_changes() {
  for (const int variable : changed_) is_listed_[to_index(variable)] = false;
  changed_.clear();
}

void BayesTree::solve_all() { solve_changed(-1); }

void BayesTree::solve_path(int variable) {
  open_stack_.clear();
  for (int number = clique_of(variable); number != kNone; number = at(number).parent) {
    open_stack_.push_back(number);
  }
  // What changes here, the next pass sees as changed in it.
  ++pass_;
  bool is_changed = false;
  while (!open_stack_.empty()) {
    Clique& clique = at(open_stack_.back());
    open_stack_.pop_back();
    solve(clique, -1, is_changed);
    clique.are_children_due = true;
  }
  --pass_;
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
