#include "baselines/karto/mapper.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "baselines/karto/running_buffer.hpp"
#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

constexpr MatchOptions kSequential{.use_penalty = true, .use_threads = true};
constexpr MatchOptions kNearChain{};  // several at a time
constexpr MatchOptions kLoopFine{.use_threads = true};

GridSpec sequential_grid(const KartoParams& params, double range_threshold_m) {
  return {params.match_resolution_m, params.match_window_m, range_threshold_m,
          params.match_smear_m};
}

GridSpec loop_grid(const KartoParams& params, double range_threshold_m) {
  return {params.loop_resolution_m, params.loop_window_m, range_threshold_m, params.loop_smear_m};
}

bool is_usable(backend::SolveStatus status) {
  return status == backend::SolveStatus::kConverged ||
         status == backend::SolveStatus::kMaxIterations;
}

}  // namespace

Mapper::Mapper(const KartoParams& params, double range_threshold_m, PoseGraph pose_graph,
               StageClock& clock, int num_threads, const MatcherFactory& make_matcher)
    : params_(params),
      clock_(clock),
      arena_(num_threads),
      sequential_matchers_(
          [=] { return make_matcher(sequential_grid(params, range_threshold_m), params); }),
      loop_matcher_(make_matcher(loop_grid(params, range_threshold_m), params)),
      pose_graph_(std::move(pose_graph)) {
  CORRIDOR_EXPECT(num_threads >= 1);
}

void Mapper::add(KeyScan scan) {
  arena_.execute([&] { add_in_arena(std::move(scan)); });
}

void Mapper::add_in_arena(KeyScan scan) {
  scan.id = static_cast<KeyScanId>(scans_.size());
  scans_.push_back(std::move(scan));
  references_m_.push_back(newest().reference_map_m());
  if (newest().id == 0) {
    add_vertex();
  } else {
    const PoseWithCovariance matched = match_with_buffer();
    move(newest(), matched.T_map_sensor);
    add_vertex();
    link_and_average(matched);
  }
  extend_buffer();
  if (params_.use_loop_closing) close_loops();
}

PoseWithCovariance Mapper::match_with_buffer() {
  const auto in_stage = clock_.enter(Stage::kMatch);
  ++counters_.sequential_matches;
  const MatchResult result =
      match(sequential_matchers_.local(), newest().T_map_sensor(), buffer_, kSequential);
  return {result.T_map_sensor, result.covariance_map};
}

void Mapper::add_vertex() {
  const auto in_stage = clock_.enter(Stage::kGraph);
  links_.add_scan();
  pose_graph_.add_pose(newest().T_map_base());
}

// The edges carry the single matches; the scan itself goes to their mean.
void Mapper::link_and_average(const PoseWithCovariance& matched) {
  const auto in_stage = clock_.enter(Stage::kGraph);
  link(newest().id - 1, matched);
  std::vector<PoseWithCovariance> estimates{matched};
  link_with_closest(buffer_, matched);
  link_with_near_chains(estimates);
  const HeadingMean heading_mean =
      params_.use_plain_mean_heading ? HeadingMean::kPlain : HeadingMean::kByInformation;
  move(newest(), mean_pose(estimates, heading_mean));
}

void Mapper::link_with_near_chains(std::vector<PoseWithCovariance>& estimates) {
  const std::vector<Chain> chains =
      near_chains(links_, references_m_, newest().id, params_.link_max_distance_m,
                  params_.loop_min_chain_scans);
  const std::vector<MatchResult> results = match_with(chains);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    ++counters_.near_chain_matches;
    if (!(results[i].response > params_.link_min_response)) continue;
    estimates.push_back({results[i].T_map_sensor, results[i].covariance_map});
    link_with_closest(chains[i], estimates.back());
    ++counters_.near_chain_links;
  }
}

// The longest chains first, each by one thread.
std::vector<MatchResult> Mapper::match_with(const std::vector<Chain>& chains) {
  const auto in_stage = clock_.enter(Stage::kMatch);
  std::vector<std::size_t> by_size(chains.size());
  std::iota(by_size.begin(), by_size.end(), 0);
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
    return chains[a].size() > chains[b].size();
  });
  std::vector<MatchResult> results(chains.size());
  std::atomic<std::size_t> next = 0;
  const auto match_remaining = [&] {
    for (std::size_t i = next++; i < chains.size(); i = next++) {
      const std::size_t chain = by_size[i];
      results[chain] =
          match(sequential_matchers_.local(), newest().T_map_sensor(), chains[chain], kNearChain);
    }
  };
  const auto num_tasks = std::min<std::size_t>(
      chains.size(), static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  tbb::parallel_for(std::size_t{0}, num_tasks, [&](std::size_t) { match_remaining(); });
  return results;
}

void Mapper::link(KeyScanId from, const PoseWithCovariance& matched) {
  if (!links_.link(from, newest().id)) return;
  pose_graph_.add_edge(from, scans_[from].T_map_base(), newest().id, matched,
                       newest().T_base_sensor());
}

void Mapper::link_with_closest(const Chain& chain, const PoseWithCovariance& matched) {
  const Eigen::Vector2d& reference_m = references_m_[newest().id];
  const KeyScanId closest = closest_in(chain, reference_m, references_m_);
  if ((references_m_[closest] - reference_m).norm() > params_.link_max_distance_m) return;
  link(closest, matched);
}

void Mapper::extend_buffer() {
  buffer_.last = newest().id;
  buffer_ = trimmed_buffer(buffer_, references_m_, params_.buffer_size_scans,
                           params_.buffer_max_distance_m);
}

void Mapper::close_loops() {
  const auto in_stage = clock_.enter(Stage::kLoopSearch);
  KeyScanId begin = 0;
  while (const auto chain =
             next_loop_candidate(links_, references_m_, newest().id, begin,
                                 params_.loop_max_distance_m, params_.loop_min_chain_scans)) {
    if (try_loop(*chain)) correct_poses();
    begin = chain->last + 1;
  }
}

// Three stages: a coarse match in the wide window, a fine one around its answer, the edge.
bool Mapper::try_loop(const Chain& chain) {
  ++counters_.coarse_loop_matches;
  const MatchOptions in_wide_window{.use_penalty = false,
                                    .use_refinement = false,
                                    .min_response = params_.loop_min_response_coarse,
                                    .use_threads = true};
  const MatchResult coarse = match(loop_matcher_, newest().T_map_sensor(), chain, in_wide_window);
  const bool is_accepted = coarse.response > params_.loop_min_response_coarse &&
                           coarse.covariance_map(0, 0) < params_.loop_max_variance_coarse_m2 &&
                           coarse.covariance_map(1, 1) < params_.loop_max_variance_coarse_m2;
  if (!is_accepted) return false;
  ++counters_.fine_loop_matches;
  const MatchResult fine =
      match(sequential_matchers_.local(), coarse.T_map_sensor, chain, kLoopFine);
  if (fine.response < params_.loop_min_response_fine) return false;
  ++counters_.loop_closures;
  move(newest(), fine.T_map_sensor);
  link_with_closest(chain, {fine.T_map_sensor, fine.covariance_map});
  return true;
}

void Mapper::correct_poses() {
  const auto in_stage = clock_.enter(Stage::kOptimise);
  const backend::BackEndReport report = pose_graph_.solve();
  counters_.dropped_factors += report.num_dropped_factors;
  if (!is_usable(report.status)) {
    ++counters_.failed_solves;
    return;
  }
  for (KeyScan& scan : scans_) {
    move(scan, pose_graph_.pose(scan.id) * scan.T_base_sensor());
  }
}

void Mapper::publish_poses() {
  std::vector<Pose2> T_map_base;
  for (const KeyScan& scan : scans_) T_map_base.push_back(scan.T_map_base());
  pose_graph_.set_poses(T_map_base);
}

void Mapper::move(KeyScan& scan, const Pose2& T_map_sensor) {
  scan.set_T_map_sensor(T_map_sensor);
  references_m_[scan.id] = scan.reference_map_m();
}

MatchResult Mapper::match(const ScanMatcher& matcher, const Pose2& T_map_sensor_predicted,
                          const Chain& local_map, const MatchOptions& options) const {
  std::vector<const KeyScan*> scans;
  for (KeyScanId id = local_map.first; id <= local_map.last; ++id) scans.push_back(&scans_[id]);
  return matcher(newest(), T_map_sensor_predicted, scans, options);
}

}  // namespace corridor::karto
