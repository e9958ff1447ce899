#include "baselines/karto/chains.hpp"

#include <algorithm>

namespace corridor::karto {
namespace {

class Neighbourhood {
 public:
  Neighbourhood(ReferencePoints references, KeyScanId centre, double radius_m)
      : references_(references), centre_m_(references[centre]), radius2_m2_(radius_m * radius_m) {}

  [[nodiscard]] bool contains(KeyScanId id) const {
    return (references_[id] - centre_m_).squaredNorm() <= radius2_m2_;
  }

  // The maximal run of consecutive ids around `id`, which must be inside.
  [[nodiscard]] Chain run_around(KeyScanId id) const {
    Chain run{id, id};
    while (run.first > 0 && contains(run.first - 1)) --run.first;
    while (run.last + 1 < references_.size() && contains(run.last + 1)) ++run.last;
    return run;
  }

 private:
  ReferencePoints references_;
  Eigen::Vector2d centre_m_;
  double radius2_m2_;
};

bool contains(const Chain& chain, KeyScanId id) { return id >= chain.first && id <= chain.last; }

}  // namespace

KeyScanId closest_in(const Chain& chain, const Eigen::Vector2d& point_m,
                     ReferencePoints references) {
  KeyScanId closest = chain.first;
  for (KeyScanId id = chain.first; id <= chain.last; ++id) {
    if ((references[id] - point_m).squaredNorm() < (references[closest] - point_m).squaredNorm()) {
      closest = id;
    }
  }
  return closest;
}

std::vector<Chain> near_chains(const ScanLinks& links, ReferencePoints references, KeyScanId scan,
                               double radius_m, int min_scans) {
  const Neighbourhood near(references, scan, radius_m);
  const auto linked = links.reachable(scan, [&](KeyScanId id) { return near.contains(id); });
  std::vector<Chain> runs;
  for (const KeyScanId id : linked) {
    const bool is_covered =
        std::any_of(runs.begin(), runs.end(), [id](const Chain& run) { return contains(run, id); });
    if (!is_covered) runs.push_back(near.run_around(id));
  }
  std::erase_if(runs,
                [&](const Chain& run) { return contains(run, scan) || run.size() < min_scans; });
  return runs;
}

std::optional<Chain> next_loop_candidate(const ScanLinks& links, ReferencePoints references,
                                         KeyScanId scan, KeyScanId begin, double radius_m,
                                         int min_scans) {
  const Neighbourhood near(references, scan, radius_m);
  std::vector<bool> is_linked(references.size(), false);
  for (const KeyScanId id :
       links.reachable(scan, [&](KeyScanId other) { return near.contains(other); })) {
    is_linked[id] = true;
  }
  std::optional<Chain> run;
  for (KeyScanId id = begin; id < references.size(); ++id) {
    if (near.contains(id)) {
      if (is_linked[id]) {
        run.reset();
      } else if (run) {
        run->last = id;
      } else {
        run = Chain{id, id};
      }
    } else if (run) {
      if (run->size() >= min_scans) return run;
      run.reset();
    }
  }
  return run;
}

}  // namespace corridor::karto
