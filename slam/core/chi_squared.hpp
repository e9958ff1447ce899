// The chi-squared distribution: how large a sum of squared standard normals gets.
#pragma once

namespace corridor {

// The bound below which the squared norm of so many standard normals stays with that probability:
// the gate of a whitened residual. Requires 0 < probability < 1, degrees_of_freedom > 0.
double chi_squared_quantile(double probability, int degrees_of_freedom);

}  // namespace corridor
