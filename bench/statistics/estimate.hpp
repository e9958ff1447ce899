// A number with its interval: what every statistic of a report is.
#pragma once

#include <cstddef>

namespace corridor::statistics {

struct Estimate {
  double value = 0;
  double low = 0;  // low <= high; the interval's ends belong to it
  double high = 0;
  double confidence = 0.95;
  std::size_t num_values = 0;

  bool operator==(const Estimate&) const = default;
};

}  // namespace corridor::statistics
