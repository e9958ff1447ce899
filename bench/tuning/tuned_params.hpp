// The parameters of the profiles `tuned`, as bench/tune.sh found them.
#pragma once

#include <string>
#include <vector>

#include "slam/core/params.hpp"

namespace corridor::tuning {

struct TunedParams {
  std::string system;
  std::string search_sha256;  // of the space, every candidate and every score
  int num_candidates = 0;
  int candidate = 0;           // the chosen one; 0 is the default profile
  int num_worlds = 0;          // development worlds each was tried on
  double default_score_m = 0;  // mean of the capped position RMSE, default profile
  double score_m = 0;          // the same, chosen candidate
  ParamValues overrides;       // on top of the default profile
};

const std::vector<TunedParams>& all_tuned_params();

}  // namespace corridor::tuning
