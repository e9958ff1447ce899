// `fusion` minus each of its parts, and on fewer sensors: what every part is worth.
#pragma once

#include <string>
#include <vector>

#include "slam/fusion/fusion_params.hpp"

namespace corridor::fusion {

struct Ablation {
  std::string name;  // "without-..."
  std::string description;
  FusionParams params;
};

// Each differs from the defaults in the switches of one part.
std::vector<Ablation> ablations();

}  // namespace corridor::fusion
