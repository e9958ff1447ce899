// A set of factors with stable numbers; factors of one type lie side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "slam/core/expect.hpp"
#include "slam/graph/any_factor.hpp"
#include "slam/graph/slot_range.hpp"

namespace corridor::graph {

using FactorId = std::size_t;

class FactorGraph {
 public:
  FactorId add(NewFactor factor);
  // The number is never given again. Requires contains(id).
  void remove(FactorId id);
  void set_kernel(FactorId id, const RobustKernel& kernel);

  [[nodiscard]] bool contains(FactorId id) const { return places_.has(id); }
  // Numbers given so far lie below this one.
  [[nodiscard]] FactorId end_id() const { return end_id_; }
  [[nodiscard]] std::size_t num_factors() const { return num_factors_; }

  // Each requires contains(id).
  [[nodiscard]] std::span<const Key> keys(FactorId id) const;
  [[nodiscard]] std::string_view name(FactorId id) const;
  [[nodiscard]] const RobustKernel& kernel(FactorId id) const;
  // ||r||^2, without the kernel.
  [[nodiscard]] double chi2(FactorId id, const Values& values) const;

  // Sum of ||r||^2 over all factors, kernels left out.
  [[nodiscard]] double chi2(const Values& values) const;
  // Sum of rho(||r||^2): what a solver makes small.
  [[nodiscard]] double cost(const Values& values) const;

  // Calls visit(factor, kernel) with the factor's own type. Requires contains(id).
  template <class Visit>
  decltype(auto) visit(FactorId id, Visit&& visit) const {
    CORRIDOR_EXPECT(contains(id));
    return visit_pool<0>(places_[id], std::forward<Visit>(visit));
  }
  // Calls visit(id, factor, kernel) for every factor, type by type.
  template <class Visit>
  void for_each(Visit&& visit) const {
    std::apply(
        [&](const auto&... pool) {
          (
              [&] {
                for (std::size_t i = 0; i < pool.factors.size(); ++i) {
                  visit(pool.ids[i], pool.factors[i], pool.kernels[i]);
                }
              }(),
              ...);
        },
        pools_);
  }

 private:
  template <class F>
  struct Pool {
    std::vector<F> factors;
    std::vector<RobustKernel> kernels;
    std::vector<FactorId> ids;
  };
  template <class Variant>
  struct PoolsOf;
  template <class... F>
  struct PoolsOf<std::variant<F...>> {
    using Type = std::tuple<Pool<F>...>;
  };
  struct Place {
    std::uint32_t type = 0, index = 0;
  };

  template <std::size_t kType, class Visit>
  decltype(auto) visit_pool(const Place& place, Visit&& visit) const {
    if constexpr (kType + 1 < std::variant_size_v<AnyFactor>) {
      if (place.type != kType) return visit_pool<kType + 1>(place, std::forward<Visit>(visit));
    }
    const auto& pool = std::get<kType>(pools_);
    return visit(pool.factors[place.index], pool.kernels[place.index]);
  }

  PoolsOf<AnyFactor>::Type pools_;
  SlotRange<Place> places_;  // by FactorId
  FactorId end_id_ = 0;
  std::size_t num_factors_ = 0;
};

}  // namespace corridor::graph
