#include "slam/backend/robust/pairwise_consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "slam/core/chi_squared.hpp"
#include "slam/core/expect.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::RelativePose;

struct Closure {
  const RelativePose* edge;
  UncertainPose z;
};

Result<std::vector<Closure>> closures_of(const graph::FactorGraph& graph,
                                         std::span<const FactorId> ids) {
  std::vector<Closure> closures;
  for (const FactorId id : ids) {
    const RelativePose* edge =
        graph.visit(id, []<class F>(const F& factor, const auto&) -> const RelativePose* {
          if constexpr (std::is_same_v<F, RelativePose>) return &factor;
          return nullptr;
        });
    CORRIDOR_EXPECT(edge != nullptr);
    Result<UncertainPose> z = uncertain_pose(*edge);
    if (!z) return tl::make_unexpected(z.error());
    closures.push_back({edge, *z});
  }
  return closures;
}

// First this, then `next`: the covariance of the first, brought to the target of the second.
UncertainPose chained(const UncertainPose& first, const UncertainPose& next) {
  return {first.T * next.T,
          transport_covariance(next.T.inverse(), first.covariance) + next.covariance};
}

}  // namespace

double inconsistency(const RelativePose& closure_ik, const UncertainPose& z_ik,
                     const RelativePose& closure_jl, const UncertainPose& z_jl,
                     const OdometryTree& odometry) {
  const auto [i, k] = closure_ik.keys();
  const auto [j, l] = closure_jl.keys();
  const UncertainPose way = chained(chained(odometry.between(i.index, j.index), z_jl),
                                    odometry.between(l.index, k.index));
  const Pose2::Tangent e = (z_ik.T.inverse() * way.T).log();
  const Eigen::Matrix3d covariance = z_ik.covariance + way.covariance;
  return e.dot(covariance.llt().solve(e));
}

Result<PcmResult> pairwise_consistency(const graph::FactorGraph& graph, const graph::Values& values,
                                       std::span<const std::uint32_t> held,
                                       std::span<const FactorId> closures,
                                       const PcmParams& params) {
  const auto odometry = OdometryTree::of(graph, values, held);
  if (!odometry) return tl::make_unexpected(odometry.error());
  const auto all = closures_of(graph, closures);
  if (!all) return tl::make_unexpected(all.error());
  constexpr int kRows = RelativePose::kRows;
  const double bound = chi_squared_quantile(params.inlier_probability, kRows);
  BitGraph agreement(all->size());
  for (std::size_t a = 0; a < all->size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Closure& first = (*all)[b];
      const Closure& second = (*all)[a];
      if (inconsistency(*first.edge, first.z, *second.edge, second.z, *odometry) <= bound) {
        agreement.join(a, b);
      }
    }
  }
  const Clique kept = maximum_clique(agreement, params.max_branches);
  PcmResult result;
  result.is_proven = kept.is_proven;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (!std::binary_search(kept.nodes.begin(), kept.nodes.end(), k)) {
      result.rejected.push_back(closures[k]);
    }
  }
  return result;
}

}  // namespace corridor::backend
