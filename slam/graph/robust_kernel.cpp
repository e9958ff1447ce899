#include "slam/graph/robust_kernel.hpp"

#include <cmath>
#include <cstddef>

namespace corridor::graph {

std::string_view to_text(KernelKind kind) {
  constexpr std::string_view kNames[] = {"none",          "huber", "cauchy",
                                         "geman-mcclure", "dcs",   "scaled"};
  return kNames[static_cast<std::size_t>(kind)];
}

double RobustKernel::cost(double s) const {
  const double k2 = width * width;
  switch (kind) {
    case KernelKind::kNone:
      return s;
    case KernelKind::kHuber:
      return s <= k2 ? s : 2 * width * std::sqrt(s) - k2;
    case KernelKind::kCauchy:
      return k2 * std::log1p(s / k2);
    case KernelKind::kGemanMcClure:
      return s / (1 + s / k2);
    case KernelKind::kDcs:
      return s <= k2 ? s : k2 * (3 - 4 / (s / k2 + 1));
    case KernelKind::kScaled:
      return k2 * s;
  }
  return s;
}

double RobustKernel::weight(double s) const {
  const double k2 = width * width;
  switch (kind) {
    case KernelKind::kNone:
      return 1;
    case KernelKind::kHuber:
      return s <= k2 ? 1 : width / std::sqrt(s);
    case KernelKind::kCauchy:
      return 1 / (1 + s / k2);
    case KernelKind::kGemanMcClure: {
      const double ratio = 1 / (1 + s / k2);
      return ratio * ratio;
    }
    case KernelKind::kDcs: {
      const double scale = s <= k2 ? 1 : 2 / (1 + s / k2);
      return scale * scale;
    }
    case KernelKind::kScaled:
      return k2;
  }
  return 1;
}

}  // namespace corridor::graph
