// From data to pixels: linear and logarithmic axes with round ticks, and the equal-aspect frame in
// which trajectories and maps are drawn.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace corridor::figures {

struct Tick {
  double value = 0;
  std::string label;
};

// Ticks at 1, 2 or 5 times a power of ten, about `target_count` of them, inside [low, high], low <
// high.
std::vector<Tick> linear_ticks(double low, double high, int target_count);
// Ticks at powers of ten (and at 2 and 5 times one, below three decades); 0 < low < high.
std::vector<Tick> log_ticks(double low, double high);

// Maps [low, high] to [begin_px, end_px] by the logarithm; values outside are clamped to the ends.
class LogScale {
 public:
  // 0 < low < high.
  LogScale(double low, double high, double begin_px, double end_px);
  [[nodiscard]] double operator()(double value) const;

 private:
  double log_low_, log_high_, begin_px_, end_px_;
};

struct Bounds {
  Eigen::Vector2d min_m = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d max_m = Eigen::Vector2d::Constant(-1e300);

  void include(const Eigen::Vector2d& point_m);
  [[nodiscard]] bool is_empty() const { return (min_m.array() > max_m.array()).any(); }
  [[nodiscard]] Eigen::Vector2d size_m() const { return max_m - min_m; }
};

// Equal aspect, +y up: `bounds` with a margin, centred in the rectangle.
class PlaneFrame {
 public:
  PlaneFrame(const Bounds& bounds, double x_px, double y_px, double width_px, double height_px,
             double margin_px);
  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& point_m) const;
  [[nodiscard]] double px_per_m() const { return px_per_m_; }
  // The part of the plane that the rectangle shows.
  [[nodiscard]] const Bounds& visible() const { return visible_; }

 private:
  double px_per_m_;
  Eigen::Vector2d centre_m_, centre_px_;
  Bounds visible_;
};

}  // namespace corridor::figures
