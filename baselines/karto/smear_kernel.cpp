#include "baselines/karto/smear_kernel.hpp"

#include <cmath>

namespace corridor::karto {

SmearKernel::SmearKernel(double sigma_m, double resolution_m)
    : half_width(static_cast<int>(std::lround(2 * sigma_m / resolution_m))),
      side(2 * half_width + 1),
      stride((side + kBlock - 1) / kBlock * kBlock),
      values(static_cast<std::size_t>(side * stride), 0) {
  for (int dy = -half_width; dy <= half_width; ++dy) {
    for (int dx = -half_width; dx <= half_width; ++dx) {
      const double ratio = std::hypot(dx * resolution_m, dy * resolution_m) / sigma_m;
      const double value = kOccupied * std::exp(-0.5 * ratio * ratio);
      values[static_cast<std::size_t>((dy + half_width) * stride + dx + half_width)] =
          static_cast<std::uint8_t>(std::lround(value));
    }
  }
}

}  // namespace corridor::karto
