#include "slam/core/nearest_names.hpp"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(NearestNames, AreThreeTheNearestFirst) {
  const std::vector<std::string> names = {"num_beams", "range_m", "ranges", "sigma_m"};
  EXPECT_EQ(nearest_names("rnge_m", names),
            (std::vector<std::string>{"range_m", "ranges", "sigma_m"}));
  EXPECT_EQ(nearest_names("beams", names).front(), "num_beams") << "a part of the name";
  EXPECT_EQ(nearest_names("x", {"y"}), std::vector<std::string>{"y"});
  EXPECT_TRUE(nearest_names("x", {}).empty());
}

}  // namespace
}  // namespace corridor
