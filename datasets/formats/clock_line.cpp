#include "datasets/formats/clock_line.hpp"

#include <cmath>
#include <cstddef>

namespace corridor::formats {
namespace {

// x: microseconds since the first stamp; y: by how much the delay differs from the first.
struct Point {
  double x = 0;
  double y = 0;
};

// Positive where the way a -> b -> c turns left.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Andrew's monotone chain, lower half.
std::vector<Point> lower_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  for (const Point& point : points) {
    while (hull.size() > 1 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
    hull.push_back(point);
  }
  return hull;
}

}  // namespace

std::int64_t ClockLine::to_logger_us(std::int64_t stamp_us) const {
  const auto since_us = static_cast<double>(stamp_us - reference_us);
  return stamp_us + static_cast<std::int64_t>(std::llround(offset_us + drift_ratio * since_us));
}

std::optional<ClockLine> clock_line(const std::vector<ClockPair>& pairs) {
  if (pairs.size() < 2) return std::nullopt;
  const std::int64_t first_us = pairs.front().stamp_us;
  const std::int64_t first_delay_us = pairs.front().received_us - first_us;
  std::vector<Point> points;
  points.reserve(pairs.size());
  for (const ClockPair& pair : pairs) {
    points.push_back({static_cast<double>(pair.stamp_us - first_us),
                      static_cast<double>(pair.received_us - pair.stamp_us - first_delay_us)});
  }
  const std::vector<Point> hull = lower_hull(points);
  const double middle = 0.5 * points.back().x;
  std::size_t end = 1;
  while (end + 1 < hull.size() && hull[end].x < middle) ++end;
  const Point& a = hull[end - 1];
  const Point& b = hull[end];
  ClockLine line;
  line.reference_us = first_us;
  line.drift_ratio = (b.y - a.y) / (b.x - a.x);
  line.offset_us = static_cast<double>(first_delay_us) + a.y - line.drift_ratio * a.x;
  return line;
}

}  // namespace corridor::formats
