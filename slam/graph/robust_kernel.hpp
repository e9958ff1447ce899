// Robust kernels: how a factor's squared error counts. The cost of a graph is sum_i rho(s_i) with
// s_i = ||r_i||^2 (no factor 1/2); a solver weights the factor by rho'(s_i) at the present estimate
// [Triggs1999, Barfoot2017 section 5.3].
#pragma once

#include <string_view>

namespace corridor::graph {

enum class KernelKind {
  kNone,          // rho = s
  kHuber,         // rho = s for s <= k^2, 2 k sqrt(s) - k^2 beyond [Huber1964]
  kCauchy,        // rho = k^2 log(1 + s / k^2)
  kGemanMcClure,  // rho = s / (1 + s / k^2), at most k^2 [GemanMcClure1985]
  // Dynamic covariance scaling [Agarwal2013]: rho' is the square of the switch in closed form,
  // min(1, 2 k^2 / (k^2 + s)) (eq. 13, Phi = k^2); so rho = s for s <= k^2,
  // k^2 (3 s - k^2) / (s + k^2) beyond, at most 3 k^2 [MacTavish2015].
  kDcs,
  kScaled,  // rho = k^2 s, k <= 1: a weight that something else has found
};

// "none", "huber", "cauchy", "geman-mcclure", "dcs", "scaled".
std::string_view to_text(KernelKind kind);

struct RobustKernel {
  KernelKind kind = KernelKind::kNone;
  double width = 1;  // k > 0, in standard deviations of the whitened residual

  // s >= 0.
  [[nodiscard]] double cost(double s) const;
  // rho'(s), in [0, 1].
  [[nodiscard]] double weight(double s) const;
};

}  // namespace corridor::graph
