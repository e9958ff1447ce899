#include "slam/graph/robust_kernel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor::graph {
namespace {

constexpr KernelKind kKinds[] = {KernelKind::kNone, KernelKind::kHuber, KernelKind::kCauchy,
                                 KernelKind::kGemanMcClure};

RC_GTEST_PROP(RobustKernel, WeightIsTheSlopeOfTheCost, (std::uint64_t seed)) {
  Rng rng(seed);
  for (const KernelKind kind : kKinds) {
    const RobustKernel kernel{kind, rng.uniform(0.1, 5)};
    const double s = rng.uniform(0.01, 50);
    const double step = 1e-5 * s;
    const double slope = (kernel.cost(s + step) - kernel.cost(s - step)) / (2 * step);
    RC_ASSERT(std::abs(slope - kernel.weight(s)) < 1e-5);
  }
}

RC_GTEST_PROP(RobustKernel, CostsNoMoreThanTheSquareAndWeighsLessTheLargerTheError,
              (std::uint64_t seed)) {
  Rng rng(seed);
  for (const KernelKind kind : kKinds) {
    const RobustKernel kernel{kind, rng.uniform(0.1, 5)};
    const double s = rng.uniform(0, 50);
    RC_ASSERT(kernel.cost(s) <= s * (1 + 1e-12));
    RC_ASSERT(kernel.weight(s) <= 1);
    RC_ASSERT(kernel.weight(s + 1) <= kernel.weight(s));
  }
}

TEST(RobustKernel, SmallErrorsCountAsTheyAre) {
  for (const KernelKind kind : kKinds) {
    EXPECT_NEAR((RobustKernel{kind, 2}.cost(1e-9)), 1e-9, 1e-17);
    EXPECT_NEAR((RobustKernel{kind, 2}.weight(0)), 1, 1e-15);
  }
}

TEST(RobustKernel, GemanMcClureIsBoundedByItsWidthSquared) {
  EXPECT_NEAR((RobustKernel{KernelKind::kGemanMcClure, 3}.cost(1e12)), 9, 1e-6);
}

}  // namespace
}  // namespace corridor::graph
