// The rigid motion that lays an estimated trajectory's frame into the world before errors are
// taken. Never a scale: wheels and LiDARs measure metres, and a wrong scale is an error of the
// system.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "bench/metrics/association.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::metrics {

enum class Alignment {
  kOrigin,  // the first matched poses are laid on each other: T_world_map = T_world_base_0 *
            // T_map_base_0^-1
  kSe2,   // least squares over all matched positions, [Umeyama1991] eq. 40-42 in the plane, scale 1
  kNone,  // map and world are taken to be one frame
};

// "origin", "se2", "none".
std::string_view to_text(Alignment alignment);
std::optional<Alignment> alignment_from_text(std::string_view text);

// T_world_map. nullopt for no pairs, and for kSe2 where the rotation is not determined (fewer than
// two distinct positions, or positions without any correlation).
std::optional<Pose2> align(std::span<const MatchedPose> pairs, Alignment alignment);

}  // namespace corridor::metrics
