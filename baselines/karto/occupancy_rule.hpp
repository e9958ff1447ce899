// Karto's published map: all key scans ray-traced anew at their final poses.
// Occupied where enough of the beams that passed or ended in a cell ended there. It does not weigh
// beams and knows no noise model.
#pragma once

#include <span>

#include "baselines/karto/karto_params.hpp"
#include "baselines/karto/key_scan.hpp"
#include "slam/core/grid_map.hpp"

namespace corridor::karto {

// A cell is observed when more than `map_min_passes` beams passed or ended in it. With share =
// ended / (passed or ended), its log-odds are logit(share) - logit(map_occupancy_threshold),
// clamped to +-5: positive exactly where Karto says occupied. Beams longer than the range threshold
// clear up to it. The map's frame is that of `T_map_frame` seen from the scans' own: cells hold
// T_frame_map * p. Empty if no scan has a beam in range.
GridMap build_karto_map(std::span<const KeyScan> scans, const Pose2& T_frame_map,
                        double range_threshold_m, const KartoParams& params);

}  // namespace corridor::karto
