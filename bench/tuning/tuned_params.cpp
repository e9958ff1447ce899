#include "bench/tuning/tuned_params.hpp"

namespace corridor::tuning {

const std::vector<TunedParams>& all_tuned_params() {
  static const std::vector<TunedParams> all = {};
  return all;
}

}  // namespace corridor::tuning
