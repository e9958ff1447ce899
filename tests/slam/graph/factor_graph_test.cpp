#include "slam/graph/factor_graph.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::graph {
namespace {

VelocityPrior velocity_prior(std::uint32_t index, double vx_mps) {
  return {index, Eigen::Vector2d(vx_mps, 0), Eigen::Vector2d::Ones()};
}

BiasPrior bias_prior(std::uint32_t index, double rate_radps) {
  return {index, {rate_radps, 0, 0, 0}, motion::ImuBias::Ones()};
}

TEST(FactorGraph, RemovedFactorsCountNoMoreAndNumbersAreNotReused) {
  FactorGraph graph;
  Values values;
  values.set_velocity(0, {3, 4});
  const FactorId first = graph.add(velocity_prior(0, 0));
  const FactorId second = graph.add(velocity_prior(0, 0));
  EXPECT_DOUBLE_EQ(graph.chi2(values), 50);
  graph.remove(first);
  EXPECT_DOUBLE_EQ(graph.chi2(values), 25);
  EXPECT_EQ(graph.num_factors(), 1u);
  EXPECT_FALSE(graph.contains(first));
  EXPECT_NE(graph.add(velocity_prior(0, 0)), first);
  EXPECT_TRUE(graph.contains(second));
}

// The prior of factor k is k, so that its error at 0 tells which one it is.
RC_GTEST_PROP(FactorGraph, NumbersNameTheSameFactorAfterAnyAdditionsAndRemovals,
              (const std::vector<std::uint8_t>& steps)) {
  FactorGraph graph;
  Values values;
  values.set_velocity(0, {0, 0});
  values.set_bias(0, motion::ImuBias::Zero());
  std::map<FactorId, std::string_view> expected;
  for (const std::uint8_t step : steps) {
    if (step % 3 == 0 && !expected.empty()) {
      const auto victim = std::next(expected.begin(), step % expected.size());
      graph.remove(victim->first);
      expected.erase(victim);
      continue;
    }
    const auto value = static_cast<double>(graph.end_id());
    const NewFactor added =
        step % 2 == 0 ? NewFactor(velocity_prior(0, value)) : NewFactor(bias_prior(0, value));
    expected.emplace(graph.add(added), name_of(added.factor));
  }
  RC_ASSERT(graph.num_factors() == expected.size());
  double chi2 = 0;
  for (const auto& [id, name] : expected) {
    RC_ASSERT(graph.contains(id));
    RC_ASSERT(graph.chi2(id, values) == static_cast<double>(id * id));
    chi2 += static_cast<double>(id * id);
  }
  RC_ASSERT(graph.chi2(values) == chi2);
  std::size_t num_visited = 0;
  graph.for_each([&](FactorId id, const auto&, const RobustKernel&) {
    RC_ASSERT(expected.contains(id));
    ++num_visited;
  });
  RC_ASSERT(num_visited == expected.size());
}

TEST(FactorGraph, TheCostBoundsAFactorWithAKernelAndChi2DoesNot) {
  FactorGraph graph;
  Values values;
  values.set_velocity(0, {10, 0});
  const FactorId id = graph.add({velocity_prior(0, 0), RobustKernel{KernelKind::kHuber, 2}});
  EXPECT_DOUBLE_EQ(graph.chi2(values), 100);
  EXPECT_DOUBLE_EQ(graph.cost(values), 2 * 2 * 10 - 4);
  graph.set_kernel(id, {KernelKind::kGemanMcClure, 10});
  EXPECT_DOUBLE_EQ(graph.cost(values), 50);
}

}  // namespace
}  // namespace corridor::graph
