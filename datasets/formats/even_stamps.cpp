#include "datasets/formats/even_stamps.hpp"

#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::formats {

EvenStamps even_stamps(const std::vector<Timestamp>& stamps) {
  CORRIDOR_EXPECT(stamps.size() >= 2);
  // Seconds since the first stamp, and indices about their middle: no large numbers to subtract.
  const auto count = static_cast<double>(stamps.size());
  const double middle = 0.5 * (count - 1);
  double mean_s = 0, covariance = 0, spread = 0;
  for (const Timestamp& stamp : stamps) mean_s += seconds_between(stamps.front(), stamp) / count;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double step = static_cast<double>(i) - middle;
    covariance += step * (seconds_between(stamps.front(), stamps[i]) - mean_s);
    spread += step * step;
  }
  EvenStamps even;
  even.period_s = covariance / spread;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double at_s = mean_s + even.period_s * (static_cast<double>(i) - middle);
    even.stamps.push_back(add_seconds(stamps.front(), at_s));
    const double move_s = std::abs(seconds_between(stamps[i], even.stamps.back()));
    if (move_s <= even.largest_move_s) continue;
    even.largest_move_s = move_s;
    even.most_moved = i;
  }
  return even;
}

}  // namespace corridor::formats
