#include "slam/graph/factor_graph.hpp"

#include <utility>

namespace corridor::graph {
namespace {

// Calls change(pool) with the pool of the type of that number.
template <class Pools, class Change, std::size_t... kTypes>
void change_pool(Pools& pools, std::uint32_t type, const Change& change,
                 std::index_sequence<kTypes...>) {
  ((kTypes == type ? change(std::get<kTypes>(pools)) : void()), ...);
}

constexpr auto kAllTypes = std::make_index_sequence<std::variant_size_v<AnyFactor>>();

}  // namespace

FactorId FactorGraph::add(NewFactor added) {
  const FactorId id = end_id_++;
  const auto type = static_cast<std::uint32_t>(added.factor.index());
  std::visit(
      [&]<class F>(F& factor) {
        auto& pool = std::get<Pool<F>>(pools_);
        places_.set(id, {type, static_cast<std::uint32_t>(pool.factors.size())});
        pool.factors.push_back(std::move(factor));
        pool.kernels.push_back(added.kernel);
        pool.ids.push_back(id);
      },
      added.factor);
  ++num_factors_;
  return id;
}

void FactorGraph::remove(FactorId id) {
  CORRIDOR_EXPECT(contains(id));
  const Place place = places_[id];
  const auto take_out = [&](auto& pool) {
    // The last one takes its place.
    places_[pool.ids.back()].index = place.index;
    pool.factors[place.index] = std::move(pool.factors.back());
    pool.kernels[place.index] = pool.kernels.back();
    pool.ids[place.index] = pool.ids.back();
    pool.factors.pop_back();
    pool.kernels.pop_back();
    pool.ids.pop_back();
  };
  change_pool(pools_, place.type, take_out, kAllTypes);
  places_.erase(id);
  --num_factors_;
}

void FactorGraph::set_kernel(FactorId id, const RobustKernel& kernel) {
  CORRIDOR_EXPECT(contains(id) && kernel.width > 0);
  const Place place = places_[id];
  change_pool(
      pools_, place.type, [&](auto& pool) { pool.kernels[place.index] = kernel; }, kAllTypes);
}

std::span<const Key> FactorGraph::keys(FactorId id) const {
  return visit(id, [](const auto& factor, const RobustKernel&) {
    return std::span<const Key>(factor.keys());
  });
}

std::string_view FactorGraph::name(FactorId id) const {
  return visit(id, []<class F>(const F&, const RobustKernel&) { return F::kName; });
}

const RobustKernel& FactorGraph::kernel(FactorId id) const {
  return visit(
      id, [](const auto&, const RobustKernel& kernel) -> const RobustKernel& { return kernel; });
}

double FactorGraph::chi2(FactorId id, const Values& values) const {
  return visit(id,
               [&](const auto& factor, const RobustKernel&) { return chi2_of(factor, values); });
}

double FactorGraph::chi2(const Values& values) const {
  double sum = 0;
  for_each(
      [&](FactorId, const auto& factor, const RobustKernel&) { sum += chi2_of(factor, values); });
  return sum;
}

double FactorGraph::cost(const Values& values) const {
  double sum = 0;
  for_each([&](FactorId, const auto& factor, const RobustKernel& kernel) {
    sum += kernel.cost(chi2_of(factor, values));
  });
  return sum;
}

}  // namespace corridor::graph
