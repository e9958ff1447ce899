// False loop closures, planted into a pose graph: place recognition that takes one place for
// another. Pairs as in [Suenderhauf2012]'s generator; what they measure, with which information, is
// that of a closure of the graph itself, drawn at random, so that nothing but the place is wrong.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"
#include "slam/core/rng.hpp"

namespace corridor::solve {

enum class FalsePairs {
  kRandom,   // two poses anywhere
  kLocal,    // two poses at most kLocalReach poses apart
  kGrouped,  // runs of kGroupSize successive poses that pass a place that looks like another
};
inline constexpr std::array kFalsePairs = {FalsePairs::kRandom, FalsePairs::kLocal,
                                           FalsePairs::kGrouped};
// "random", "local", "grouped".
std::string_view to_text(FalsePairs pairs);

inline constexpr std::size_t kLocalReach = 20;  // [Suenderhauf2012] section V
inline constexpr std::size_t kGroupSize = 10;

// Appends false closures behind the graph's own edges until they are `share` of all closures; no
// pair is consecutive. That one is true by chance is not ruled out. Requires 0 <= share < 1. The
// Error: the graph has no closure to imitate, or too few poses.
Result<formats::PoseGraph> with_false_closures(formats::PoseGraph graph, double share,
                                               FalsePairs pairs, const Rng& rng);

// Neither where no edge is false.
struct RejectionScore {
  std::optional<double> precision;  // share of the rejected that are false; nothing rejected: none
  std::optional<double> recall;     // share of the false that are rejected
};
// Of edges by number, of which those from `first_false` on are false.
RejectionScore score_of(std::span<const graph::FactorId> rejected, std::size_t first_false,
                        std::size_t num_edges);

}  // namespace corridor::solve
