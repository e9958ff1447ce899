#include "slam/core/chi_squared.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include "slam/core/expect.hpp"

namespace corridor {

double chi_squared_quantile(double probability, int degrees_of_freedom) {
  CORRIDOR_EXPECT(probability > 0 && probability < 1 && degrees_of_freedom > 0);
  return boost::math::quantile(boost::math::chi_squared(degrees_of_freedom), probability);
}

}  // namespace corridor
