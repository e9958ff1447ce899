#include "slam/backend/isam2/marginalization.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "slam/backend/isam2/front.hpp"
#include "slam/backend/weighted_terms.hpp"

namespace corridor::backend {
namespace {

// Rows of a dense front: the eliminated variables, then the others in the order of their keys.
struct FrontRows {
  std::map<graph::Key, int> row_of;
  std::vector<graph::Key> kept;
  int num_pivots = 0, num_below = 0;
};

FrontRows rows_of(const graph::FactorGraph& graph, std::span<const graph::FactorId> factors,
                  std::span<const graph::Key> eliminated) {
  FrontRows rows;
  for (const graph::Key key : eliminated) {
    rows.row_of.emplace(key, rows.num_pivots);
    rows.num_pivots += key.dimension();
  }
  for (const graph::FactorId id : factors) {
    for (const graph::Key key : graph.keys(id)) {
      if (!rows.row_of.contains(key)) rows.kept.push_back(key);
    }
  }
  std::sort(rows.kept.begin(), rows.kept.end());
  rows.kept.erase(std::unique(rows.kept.begin(), rows.kept.end()), rows.kept.end());
  for (const graph::Key key : rows.kept) {
    rows.row_of.emplace(key, rows.num_pivots + rows.num_below);
    rows.num_below += key.dimension();
  }
  return rows;
}

void add_factor(const graph::FactorGraph& graph, graph::FactorId id, const graph::Values& values,
                const FrontRows& rows, Front& front) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    linearize_weighted(factor, kernel, values, r, J);
    const auto row = [&](std::size_t key) { return rows.row_of.at(factor.keys()[key]); };
    for_each_block(
        factor, J,
        [&](std::size_t a, const auto& J_a) {
          front.add_gradient(row(a), (J_a.transpose() * r).eval());
        },
        [&](std::size_t a, std::size_t b, const auto& J_a, const auto& J_b) {
          front.add(row(a), row(b), (J_a.transpose() * J_b).eval());
        });
  });
}

}  // namespace

Result<std::optional<graph::GaussianPrior>> marginal_prior(const graph::FactorGraph& graph,
                                                           const graph::Values& values,
                                                           std::span<const graph::FactorId> factors,
                                                           std::span<const graph::Key> eliminated) {
  const FrontRows rows = rows_of(graph, factors, eliminated);
  if (rows.kept.empty()) return std::nullopt;
  std::vector<double> memory(Front::memory_size(rows.num_pivots, rows.num_below));
  Front front(memory.data(), rows.num_pivots, rows.num_below);
  for (const graph::FactorId id : factors) add_factor(graph, id, values, rows, front);
  const int num_good = front.eliminate();
  if (num_good < rows.num_pivots) {
    const auto bad = std::find_if(eliminated.begin(), eliminated.end(), [&](graph::Key key) {
      return num_good < rows.row_of.at(key) + key.dimension();
    });
    return fail(ErrorCode::kInvalid, "no factor determines " + graph::to_text(*bad),
                "marginalisation");
  }
  Eigen::MatrixXd H(rows.num_below, rows.num_below);
  Eigen::VectorXd g(rows.num_below);
  for (int c = 0; c < rows.num_below; ++c) {
    const double* const column = front.update_column(rows.num_pivots + c) + rows.num_pivots;
    for (int r = c; r < rows.num_below; ++r) H(r, c) = H(c, r) = column[r];
    g(c) = -column[rows.num_below];
  }
  return std::optional(graph::GaussianPrior::from_information(rows.kept, values, H, g));
}

}  // namespace corridor::backend
