#include "baselines/karto/karto_params.hpp"

namespace corridor::karto {

KartoParams corrected_params() {
  KartoParams params;
  params.count_no_returns = false;
  params.wrap_rows = false;
  params.use_plain_mean_heading = false;
  return params;
}

}  // namespace corridor::karto
