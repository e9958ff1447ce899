// The filter proper: particles, prediction, scan matching, weights, resampling, map registration.
// It does not decide which scans to use and knows nothing of events or stamps.
#pragma once

#include <tbb/task_arena.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "baselines/gmapping/ancestry.hpp"
#include "baselines/gmapping/end_point_map.hpp"
#include "baselines/gmapping/gmapping_params.hpp"
#include "baselines/gmapping/hill_climb.hpp"
#include "baselines/gmapping/motion_model.hpp"
#include "baselines/gmapping/scan_points.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::gmapping {

struct Particle {
  explicit Particle(double cell_size_m) : map(cell_size_m) {}

  void add_log_weight(double log_likelihood) {
    log_weight += log_likelihood;
    log_weight_sum += log_likelihood;
  }

  Pose2 T_map_base;
  double log_weight = 0;      // since the last resampling
  double log_weight_sum = 0;  // over the whole ancestry, never reset
  std::size_t node = Ancestry::kNoParent;
  EndPointMap map;
};

// Every function works on all particles in parallel, each with random numbers of its own stream
// (particle, step), and sums in the order of the particles: results do not depend on num_threads.
class ParticleFilter {
 public:
  ParticleFilter(const GmappingParams& params, Rng rng, int num_threads);

  // Moves every particle by a noisy sample of the odometry step; with a sampled proposal, which
  // draws later, by the step itself.
  void predict(const Pose2& T_before_after);
  // Puts every particle on its best match and adds the log-likelihood there to its weights; with a
  // sampled proposal draws its pose around the match and adds the proposal's log-normaliser.
  void match_and_weigh(const ScanPoints& points);
  // Resamples if the effective number of particles is below the threshold; true if it did.
  bool resample_if_needed();
  // Adds the scan to every particle's map and its pose to the ancestry.
  void register_scan(const ScanPoints& points);

  // The particle with the largest log-likelihood over its whole ancestry; the first of equals.
  [[nodiscard]] const Particle& best() const;
  [[nodiscard]] std::vector<Pose2> best_path() const { return ancestry_.path_to(best().node); }
  [[nodiscard]] const std::vector<Particle>& particles() const { return particles_; }
  [[nodiscard]] double num_score_evaluations() const { return num_score_evaluations_; }

 private:
  void for_each_particle(const std::function<void(std::size_t)>& work);
  void take_match(Particle& particle, const HillClimbResult& match, const ScanPoints& points) const;
  void draw_around_match(Particle& particle, const HillClimbResult& match, const ScanPoints& points,
                         Rng rng) const;

  GmappingParams params_;
  Rng motion_rng_;
  Rng proposal_rng_;
  Rng resampling_rng_;
  tbb::task_arena arena_;
  std::vector<Particle> particles_;
  Ancestry ancestry_;
  Pose2 T_used_now_;        // odometry since the last used scan
  MotionNoise used_noise_;  // and its noise, step by step as predict() would have drawn it
  std::uint64_t num_predictions_ = 0;
  std::uint64_t num_matches_ = 0;
  std::uint64_t num_resamplings_ = 0;
  double num_score_evaluations_ = 0;
};

}  // namespace corridor::gmapping
