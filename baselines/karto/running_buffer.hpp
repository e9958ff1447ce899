// The newest key scans, the local map of sequential matching: a range of consecutive ids.
#pragma once

#include "baselines/karto/chains.hpp"

namespace corridor::karto {

// The buffer after the newest scan joined it: scans are dropped from the front while there are more
// than `max_scans` or the first lies more than `max_distance_m` from the last. The last one stays.
inline Chain trimmed_buffer(Chain buffer, ReferencePoints references, int max_scans,
                            double max_distance_m) {
  const auto is_too_long = [&] {
    return buffer.size() > max_scans ||
           (references[buffer.first] - references[buffer.last]).norm() > max_distance_m;
  };
  while (buffer.first < buffer.last && is_too_long()) ++buffer.first;
  return buffer;
}

}  // namespace corridor::karto
