// Parameters of the GMapping-style filter; the defaults are those its ROS node ships with.
// Where the original's name is known to users it stands in the comment of the field.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/core/params.hpp"

namespace corridor::gmapping {

struct GmappingParams {
  int num_particles = 30;                    // particles
  double cell_size_m = 0.05;                 // delta
  double linear_update_m = 1.0;              // linearUpdate
  double angular_update_rad = 0.5;           // angularUpdate
  double range_margin_m = 0.01;              // maxUrange = maxRange = sensor maximum - this
  double beam_tilt_steps = -0.5;             // how the original lays out its beams
  double translation_noise_per_m = 0.1;      // srr
  double rotation_noise_rad_per_m = 0.2;     // srt
  double translation_noise_m_per_rad = 0.1;  // str
  double rotation_noise_per_rad = 0.2;       // stt
  double score_sigma_m2 = 0.05;              // sigma
  int kernel_size_cells = 1;                 // kernelSize
  int num_skipped_beams = 0;                 // lskip
  double linear_step_m = 0.05;               // lstep
  double angular_step_rad = 0.05;            // astep
  int num_refinements = 5;                   // iterations
  double min_score = 0;                      // minimumScore
  double likelihood_sigma_m2 = 0.075;        // lsigma
  double weight_gain = 3.0;                  // ogain
  double resample_threshold_ratio = 0.5;     // resampleThreshold
  double map_occupied_ratio = 0.25;          // occ_thresh

  // Switches of the `as-published` profile; false is what the original does.
  bool sample_proposal = false;
  bool require_free_front = false;
  // For a robot with a gyro; the original knows none.
  bool use_gyro_odometry = false;
  // The lattice around the optimum that the sampled proposal is fitted to.
  double proposal_linear_range_m = 0.01;      // llsamplerange
  double proposal_linear_step_m = 0.01;       // llsamplestep
  double proposal_angular_range_rad = 0.005;  // lasamplerange
  double proposal_angular_step_rad = 0.005;   // lasamplestep

  template <class V>
  static void visit(GmappingParams& p, V&& v) {
    v(ParamInfo{"use_gyro_odometry", "",
                "turns of the odometry from an EKF of wheels and gyro; the original has no gyro"},
      p.use_gyro_odometry);
    v(ParamInfo{"num_particles", "1", "number of particles", 1, 100000}, p.num_particles);
    v(ParamInfo{"cell_size_m", "m", "side of a map cell", 0.005, 1}, p.cell_size_m);
    v(ParamInfo{"linear_update_m", "m",
                "odometry path since the last used scan that makes the next one used", 0, 100},
      p.linear_update_m);
    v(ParamInfo{"angular_update_rad", "rad", "the same for the sum of absolute rotations", 0, 100},
      p.angular_update_rad);
    v(ParamInfo{"range_margin_m", "m",
                "beams longer than the sensor's maximum minus this are ignored", 0, 100},
      p.range_margin_m);
    v(ParamInfo{"beam_tilt_steps", "1",
                "turns all beams by this many angular steps: -0.5 as the original does by mistake, "
                "0 = where they are",
                -1, 1},
      p.beam_tilt_steps);
    v(ParamInfo{"translation_noise_per_m", "m/m",
                "translation noise per translation, standard deviation", 0, 10},
      p.translation_noise_per_m);
    v(ParamInfo{"rotation_noise_rad_per_m", "rad/m",
                "rotation noise per translation, standard deviation", 0, 10},
      p.rotation_noise_rad_per_m);
    v(ParamInfo{"translation_noise_m_per_rad", "m/rad",
                "translation noise per rotation, standard deviation", 0, 10},
      p.translation_noise_m_per_rad);
    v(ParamInfo{"rotation_noise_per_rad", "rad/rad",
                "rotation noise per rotation, standard deviation", 0, 10},
      p.rotation_noise_per_rad);
    v(ParamInfo{"score_sigma_m2", "m^2", "a beam at distance d scores exp(-d^2 / this)", 1e-6, 100},
      p.score_sigma_m2);
    v(ParamInfo{"kernel_size_cells", "1", "cells searched around an end point in each direction", 0,
                15},
      p.kernel_size_cells);
    v(ParamInfo{"num_skipped_beams", "1", "beams left out between two used ones when matching", 0,
                10000},
      p.num_skipped_beams);
    v(ParamInfo{"linear_step_m", "m", "first translation step of the hill climb", 1e-6, 10},
      p.linear_step_m);
    v(ParamInfo{"angular_step_rad", "rad", "first rotation step of the hill climb", 1e-6, 3},
      p.angular_step_rad);
    v(ParamInfo{"num_refinements", "1", "how often the hill climb halves its steps", 0, 50},
      p.num_refinements);
    v(
        ParamInfo{
            "min_score", "1",
            "a match is used if its score is larger; 50 to 100 avoids jumps of short-range sensors",
            0, 1e9},
        p.min_score);
    v(ParamInfo{"likelihood_sigma_m2", "m^2",
                "log-likelihood of a beam at distance d is -d^2 / this", 1e-6, 100},
      p.likelihood_sigma_m2);
    v(ParamInfo{"weight_gain", "1", "log-likelihoods are divided by this times num_particles", 1e-3,
                1e6},
      p.weight_gain);
    v(ParamInfo{"resample_threshold_ratio", "1",
                "resample when the effective number of particles falls below this share", 0, 1},
      p.resample_threshold_ratio);
    v(ParamInfo{"map_occupied_ratio", "1",
                "cells of the published map with more hits per visit are occupied", 0.01, 0.99},
      p.map_occupied_ratio);
    visit_proposal(p, v);
  }

  // Rules across fields.
  [[nodiscard]] std::vector<std::string> relations() const {
    std::vector<std::string> broken;
    check_lattice("proposal_linear_step_m", proposal_linear_step_m, proposal_linear_range_m,
                  broken);
    check_lattice("proposal_angular_step_rad", proposal_angular_step_rad,
                  proposal_angular_range_rad, broken);
    return broken;
  }

 private:
  // Poses around the optimum, but not by the million.
  static void check_lattice(std::string_view name, double step, double range,
                            std::vector<std::string>& broken) {
    constexpr double kMaxSteps = 20;
    if (step <= range && range <= kMaxSteps * step) return;
    broken.push_back(
        fmt::format("{} = {}: expected the range {} over 1 to {}", name, step, range, kMaxSteps));
  }

  template <class V>
  static void visit_proposal(GmappingParams& p, V& v) {
    v(ParamInfo{"sample_proposal", "",
                "draw each pose from a Gaussian fitted around the best match; false: take the best "
                "match"},
      p.sample_proposal);
    v(ParamInfo{"require_free_front", "",
                "an end point is compared only with cells that have a free one before them"},
      p.require_free_front);
    v(ParamInfo{"proposal_linear_range_m", "m",
                "poses around the best match that shape the Gaussian, to each side", 0, 1},
      p.proposal_linear_range_m);
    v(ParamInfo{"proposal_linear_step_m", "m", "distance of two of them", 1e-6, 1},
      p.proposal_linear_step_m);
    v(ParamInfo{"proposal_angular_range_rad", "rad", "the same for the heading", 0, 1},
      p.proposal_angular_range_rad);
    v(ParamInfo{"proposal_angular_step_rad", "rad", "distance of two of them", 1e-6, 1},
      p.proposal_angular_step_rad);
  }
};

// Two things that [Grisetti2007] describes and the program does not do: poses drawn from a Gaussian
// around the best match with weights by its normaliser, and a free cell before every end point. All
// else stays as shipped.
GmappingParams published_params();

}  // namespace corridor::gmapping
