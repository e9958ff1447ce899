#include "slam/core/chi_squared.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor {
namespace {

TEST(ChiSquared, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_squared_quantile(0.99, 3), 11.345, 5e-4);
  EXPECT_NEAR(chi_squared_quantile(0.95, 1), 3.841, 5e-4);
  // Two degrees of freedom are exponential: -2 log(1 - p).
  EXPECT_NEAR(chi_squared_quantile(0.9, 2), -2 * std::log(0.1), 1e-12);
}

}  // namespace
}  // namespace corridor
