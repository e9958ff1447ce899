#include "baselines/gmapping/particle_filter.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "baselines/gmapping/motion_model.hpp"
#include "baselines/gmapping/proposal.hpp"
#include "baselines/gmapping/resampling.hpp"
#include "baselines/gmapping/scan_score.hpp"
#include "slam/core/expect.hpp"

namespace corridor::gmapping {

ParticleFilter::ParticleFilter(const GmappingParams& params, Rng rng, int num_threads)
    : params_(params),
      motion_rng_(rng.stream("motion")),
      proposal_rng_(rng.stream("proposal")),
      resampling_rng_(rng.stream("resampling")),
      arena_(num_threads),
      particles_(static_cast<std::size_t>(params.num_particles), Particle(params.cell_size_m)) {
  CORRIDOR_EXPECT(param_violations(params).empty());
  CORRIDOR_EXPECT(num_threads >= 1);
}

void ParticleFilter::predict(const Pose2& T_before_after) {
  const MotionNoise noise = motion_noise(T_before_after, params_);
  T_used_now_ = T_used_now_ * T_before_after;
  used_noise_.add(noise);
  if (params_.sample_proposal) {
    for (Particle& particle : particles_) {
      particle.T_map_base = particle.T_map_base * T_before_after;
    }
    return;
  }
  const Rng step_rng = motion_rng_.stream(num_predictions_++);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Rng rng = step_rng.stream(i);
    particles_[i].T_map_base = sample_motion(particles_[i].T_map_base, T_before_after, noise, rng);
  }
}

void ParticleFilter::match_and_weigh(const ScanPoints& points) {
  const HillClimbSteps steps{.linear_m = params_.linear_step_m,
                             .angular_rad = params_.angular_step_rad,
                             .num_refinements = params_.num_refinements};
  const Rng match_rng = proposal_rng_.stream(num_matches_++);
  std::vector<int> num_evaluations(particles_.size());
  for_each_particle([&](std::size_t i) {
    Particle& particle = particles_[i];
    const HillClimbResult match =
        hill_climb(particle.T_map_base, steps, [&](const Pose2& T_map_base) {
          return scan_score(particle.map, points, T_map_base, params_);
        });
    if (params_.sample_proposal) {
      draw_around_match(particle, match, points, match_rng.stream(i));
    } else {
      take_match(particle, match, points);
    }
    num_evaluations[i] = match.num_evaluations;
  });
  num_score_evaluations_ =
      std::accumulate(num_evaluations.begin(), num_evaluations.end(), num_score_evaluations_);
}

// As shipped. A match that is too poor leaves the particle where odometry put it.
void ParticleFilter::take_match(Particle& particle, const HillClimbResult& match,
                                const ScanPoints& points) const {
  if (match.score > params_.min_score) particle.T_map_base = match.T_map_base;
  particle.add_log_weight(scan_log_likelihood(particle.map, points, particle.T_map_base, params_));
}

// [Grisetti2007] algorithm 1: the target is observation times motion, the weight its sum. After a
// poor match, a sample of the motion, weighed by the observation.
void ParticleFilter::draw_around_match(Particle& particle, const HillClimbResult& match,
                                       const ScanPoints& points, Rng rng) const {
  const Pose2 T_map_before = particle.T_map_base * T_used_now_.inverse();
  if (!(match.score > params_.min_score)) {
    particle.T_map_base = sample_motion(T_map_before, T_used_now_, used_noise_, rng);
    particle.add_log_weight(
        scan_log_likelihood(particle.map, points, particle.T_map_base, params_));
    return;
  }
  const GaussianProposal proposal =
      fit_proposal(match.T_map_base, params_, [&](const Pose2& T_map_base) {
        return scan_log_likelihood(particle.map, points, T_map_base, params_) +
               log_motion_density(T_map_before, T_map_base, T_used_now_, used_noise_);
      });
  particle.T_map_base = draw_pose(proposal, rng);
  particle.add_log_weight(proposal.log_normaliser);
}

bool ParticleFilter::resample_if_needed() {
  std::vector<double> log_weights;
  for (const Particle& particle : particles_) log_weights.push_back(particle.log_weight);
  const std::vector<double> weights = normalised_weights(log_weights, params_.weight_gain);
  const double threshold =
      params_.resample_threshold_ratio * static_cast<double>(particles_.size());
  if (effective_sample_size(weights) >= threshold) return false;
  const double start = resampling_rng_.stream(num_resamplings_++).uniform();
  std::vector<Particle> survivors;
  survivors.reserve(particles_.size());
  for (const std::size_t index : systematic_resample(weights, start)) {
    survivors.push_back(particles_[index]);
    survivors.back().log_weight = 0;
  }
  particles_ = std::move(survivors);
  return true;
}

void ParticleFilter::register_scan(const ScanPoints& points) {
  for_each_particle(
      [&](std::size_t i) { particles_[i].map.insert(points, particles_[i].T_map_base); });
  T_used_now_ = Pose2();
  used_noise_ = {};
  for (Particle& particle : particles_) {
    particle.node = ancestry_.add(particle.T_map_base, particle.node);
  }
}

const Particle& ParticleFilter::best() const {
  return *std::max_element(
      particles_.begin(), particles_.end(),
      [](const Particle& a, const Particle& b) { return a.log_weight_sum < b.log_weight_sum; });
}

void ParticleFilter::for_each_particle(const std::function<void(std::size_t)>& work) {
  arena_.execute([&] { tbb::parallel_for(std::size_t{0}, particles_.size(), work); });
}

}  // namespace corridor::gmapping
