#include "reports/figures/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace corridor::figures {
namespace {

// Smallest extent an axis shows: a robot that stood still still gets a picture.
constexpr double kMinExtent_m = 0.1;

double round_step(double raw_step) {
  const double power = std::pow(10.0, std::floor(std::log10(raw_step)));
  const double mantissa = raw_step / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int target_count) {
  const double step = round_step((high - low) / target_count);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  const auto first = static_cast<long long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long long>(std::floor(high / step + 1e-9));
  for (long long index = first; index <= last; ++index) {
    const double value = static_cast<double>(index) * step;
    ticks.push_back({value, fmt::format("{:.{}f}", value, decimals)});
  }
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high) {
  const bool is_wide = std::log10(high / low) > 3;
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int exponent = first; exponent <= last; ++exponent) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, exponent);
      const bool is_inside = value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9);
      if (is_inside && (factor == 1 || !is_wide))
        ticks.push_back({value, fmt::format("{:.6g}", value)});
    }
  }
  return ticks;
}

LogScale::LogScale(double low, double high, double begin_px, double end_px)
    : log_low_(std::log(low)), log_high_(std::log(high)), begin_px_(begin_px), end_px_(end_px) {}

double LogScale::operator()(double value) const {
  const double ratio = value > 0 ? (std::log(value) - log_low_) / (log_high_ - log_low_) : 0.0;
  return begin_px_ + std::clamp(ratio, 0.0, 1.0) * (end_px_ - begin_px_);
}

void Bounds::include(const Eigen::Vector2d& point_m) {
  if (!point_m.allFinite()) return;
  min_m = min_m.cwiseMin(point_m);
  max_m = max_m.cwiseMax(point_m);
}

PlaneFrame::PlaneFrame(const Bounds& bounds, double x_px, double y_px, double width_px,
                       double height_px, double margin_px) {
  const Bounds shown =
      bounds.is_empty() ? Bounds{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()} : bounds;
  const Eigen::Vector2d size_m = shown.size_m().cwiseMax(kMinExtent_m);
  px_per_m_ =
      std::min((width_px - 2 * margin_px) / size_m.x(), (height_px - 2 * margin_px) / size_m.y());
  centre_m_ = 0.5 * (shown.min_m + shown.max_m);
  centre_px_ = {x_px + 0.5 * width_px, y_px + 0.5 * height_px};
  const Eigen::Vector2d half_m = 0.5 / px_per_m_ * Eigen::Vector2d(width_px, height_px);
  visible_ = {centre_m_ - half_m, centre_m_ + half_m};
}

Eigen::Vector2d PlaneFrame::operator()(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d offset_m = point_m - centre_m_;
  return {centre_px_.x() + px_per_m_ * offset_m.x(), centre_px_.y() - px_per_m_ * offset_m.y()};
}

}  // namespace corridor::figures
