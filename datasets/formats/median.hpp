// The median as readers use it: of an even number of values the upper one. Internal to this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::formats {

// Requires a value.
template <class T>
T upper_median(std::vector<T> values) {
  CORRIDOR_EXPECT(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace corridor::formats
