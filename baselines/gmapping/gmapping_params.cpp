#include "baselines/gmapping/gmapping_params.hpp"

namespace corridor::gmapping {

GmappingParams published_params() {
  GmappingParams params;
  params.sample_proposal = true;
  params.require_free_front = true;
  return params;
}

}  // namespace corridor::gmapping
