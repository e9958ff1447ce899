#include "slam/graph/robust_kernel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor::graph {
namespace {

constexpr KernelKind kKinds[] = {KernelKind::kNone, KernelKind::kHuber, KernelKind::kCauchy,
                                 KernelKind::kGemanMcClure, KernelKind::kDcs};

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

TEST(RobustKernel, DcsIsTheSquareUpToItsWidthAndBoundedByThriceItsSquare) {
  const RobustKernel kernel{KernelKind::kDcs, 2};
  EXPECT_DOUBLE_EQ(kernel.cost(3.9), 3.9);
  EXPECT_DOUBLE_EQ(kernel.weight(3.9), 1);
  // s = 12 = 3 Phi: the switch is 2 * 4 / (4 + 12) = 1/2; rho = 4 (36 - 4) / 16.
  EXPECT_DOUBLE_EQ(kernel.weight(12), 0.25);
  EXPECT_DOUBLE_EQ(kernel.cost(12), 8);
  EXPECT_NEAR(kernel.cost(1e12), 12, 1e-6);
}

// At the switch of DCS, [Suenderhauf2012]'s cost s^2 chi2 + Phi (1 - s)^2 is never above that of
// the plain square, and of all scales between 0 and 1 its slope in chi2 is the kernel's weight.
TEST(RobustKernel, DcsWeighsAsTheSwitchOfSwitchableConstraintsSquared) {
  const double phi = 1;
  for (const double chi2 : {0.5, 1.0, 4.0, 100.0}) {
    const double scale = std::min(1.0, 2 * phi / (phi + chi2));
    EXPECT_DOUBLE_EQ((RobustKernel{KernelKind::kDcs, 1}.weight(chi2)), scale * scale);
    EXPECT_LE(scale * scale * chi2 + phi * (1 - scale) * (1 - scale), chi2);
  }
}

RC_GTEST_PROP(RobustKernel, ScaledIsTheSquareTimesAConstant, (std::uint64_t seed)) {
  Rng rng(seed);
  const RobustKernel kernel{KernelKind::kScaled, rng.uniform(0.01, 1)};
  const double s = rng.uniform(0, 50);
  RC_ASSERT(kernel.cost(s) == kernel.weight(s) * s);
  RC_ASSERT(kernel.weight(s) == kernel.width * kernel.width);
}

}  // namespace
}  // namespace corridor::graph
