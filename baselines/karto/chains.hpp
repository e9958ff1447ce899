// Runs of consecutive key scans near a place: earlier passes to link with, and loop candidates.
// [Konolige2010] section V, as shipped. Distances are between reference points of the scans.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "baselines/karto/scan_links.hpp"

namespace corridor::karto {

// Key scans first, first + 1, ..., last.
struct Chain {
  KeyScanId first = 0;
  KeyScanId last = 0;

  [[nodiscard]] int size() const { return static_cast<int>(last - first) + 1; }
  bool operator==(const Chain&) const = default;
};

// Reference points of all key scans, by id; the newest scan is the last.
using ReferencePoints = std::span<const Eigen::Vector2d>;

// The scan of a chain closest to a point; the earliest of several.
KeyScanId closest_in(const Chain& chain, const Eigen::Vector2d& point_m,
                     ReferencePoints references);

// Scans reached from `scan` by edges staying within `radius_m` of it, each extended to the maximal
// run of consecutive ids inside that radius, in order of discovery. A run that contains `scan`
// itself is no earlier pass and is left out; so are runs of fewer than `min_scans`.
std::vector<Chain> near_chains(const ScanLinks& links, ReferencePoints references, KeyScanId scan,
                               double radius_m, int min_scans);

// The first loop candidate from id `begin` on: a run of consecutive scans within `radius_m` of
// `scan`, none of which is linked to it by edges staying within that radius. A linked scan clears
// the run. A scan out of radius ends it: returned if it has `min_scans`, else cleared. A run that
// reaches the last id is returned whatever its length.
std::optional<Chain> next_loop_candidate(const ScanLinks& links, ReferencePoints references,
                                         KeyScanId scan, KeyScanId begin, double radius_m,
                                         int min_scans);

}  // namespace corridor::karto
