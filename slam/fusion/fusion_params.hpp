// Parameters of the fusion system, one home for all of its parts.
#pragma once

#include <string>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/mapping/occupancy_mapper.hpp"
#include "slam/matching/correlative_search.hpp"
#include "slam/matching/observability.hpp"
#include "slam/matching/scan_matcher.hpp"

namespace corridor::fusion {

struct FusionParams {
  // Which of the two methods: the published one, or ours. Each is a switch, so that an ablation can
  // walk from one to the other.
  bool use_directional_degeneracy = true;  // false: the paper's scalar test of consecutive scans
  bool use_statistical_slip_test = true;   // false: the paper's fixed threshold
  bool use_submaps = true;                 // false: match against the last key scan only
  bool use_submap_refinement = true;       // match the scans of a finished submap against all of it
  bool use_wheel_scale = true;             // estimate the wheels' common scale error
  bool use_wheel_turn = true;              // estimate unequal wheels and the track's error
  bool use_wheel_delay = true;             // estimate the wheels' clock against the LiDAR's
  bool use_axle_pose = true;               // estimate where the wheels' axle lies under the LiDAR
  bool use_gyro_scale = true;              // estimate the gyro's scale error
  bool use_majority_vote = true;           // LiDAR out where wheels and IMU both contradict it
  bool use_loop_closing = true;
  bool use_wheels = true;  // false: as if the robot had none
  bool use_imu = true;

  double key_distance_m = 0.1;
  double key_angle_rad = 0.1;
  double key_interval_s = 2.0;  // only with an IMU, whose errors grow with time
  double max_range_m = 30.0;

  double fine_resolution_m = 0.1;
  double coarse_resolution_m = 0.4;
  int submap_key_scans = 40;

  double wheel_translation_floor_m = 0.001;
  double wheel_translation_ratio = 0.005;
  double wheel_rotation_floor_rad = 0.002;
  double wheel_rotation_per_m_rad = 0.01;
  double wheel_rotation_ratio = 0.03;
  double wheel_scale_sigma = 0.02;
  double wheel_unbalance_sigma_radpm = 0.03;
  double wheel_turn_sigma = 0.05;
  double wheel_delay_sigma_s = 0.1;
  double axle_position_sigma_m = 0.1;
  double axle_heading_sigma_rad = 0.03;
  double gyro_scale_sigma = 0.01;
  double calibration_interval_m = 20;    // path from one state of the calibration to the next
  double calibration_walk_ratio = 0.02;  // its change over that path, as a share of the priors
  double max_wheel_noise_factor = 50;    // of the online adaptation to bad wheels

  double initial_velocity_sigma_mps = 1.0;
  double gyro_bias_sigma_radps = 0.01;
  double accel_bias_sigma_mps2 = 0.1;
  double velocity_sigma_mps = 0.02;  // of the estimate, for the slip test

  double slip_gate = 20.0;               // chi-square with 2 degrees of freedom: 5e-5
  double slip_threshold_m = 0.05;        // the paper's test
  double degeneracy_floor_factor = 1.5;  // the paper's test, times the noise floor of the measure
  double degeneracy_travel_m = 0.2;      // the paper's test compares scans this far apart
  double lidar_sigma_m = 0.01;           // the paper's constant LiDAR noise
  double lidar_sigma_rad = 0.003;

  double match_prior_sigma_m = 0.02;  // least width of the prediction while matching near it
  double match_prior_sigma_rad = 0.02;
  int hold_unseen_passes = 2;  // further matches, held at the prediction where the last saw nothing
  double vote_gate = 9.0;  // chi-square with 1 degree of freedom, of wheels and IMU each: 3 sigma
  double jump_inlier_ratio = 0.8;  // a match that contradicts the prediction must explain this much
  double retry_inlier_ratio = 0.8;   // fewer explained points: look further away
  double retry_gain_ratio = 0.2;     // a match from further away must explain this much more
  double retry_prior_sigma_m = 0.1;  // least width of the prediction while matching further away
  double retry_prior_sigma_rad = 0.05;
  double retry_window_m = 0.8;
  double retry_window_rad = 0.3;

  double loop_min_path_m = 10.0;
  double loop_interval_m = 0.5;
  double loop_radius_m = 3.0;
  double loop_drift_ratio = 0.03;  // of the path since the last closure: the search window
  double loop_max_window_m = 4.0;
  double loop_max_window_rad = 0.5;
  double loop_min_inlier_ratio = 0.75;
  int loop_min_agreeing = 3;       // closures that agree in pairs before one counts
  double loop_min_span_m = 1.0;    // path along which they are spread
  double loop_memory_m = 10.0;     // path after which one that waits is forgotten
  double loop_agreement_m = 0.15;  // two closures agree, beside the drift between them
  double loop_agreement_rad = 0.05;
  double loop_link_m =
      3.0;  // path from the newest closure on which key scans match old submaps directly
  double loop_sigma_m = 0.02;  // error of a submap's shape, beside a closure's own
  double loop_sigma_rad = 0.004;
  double loop_gate = 30.0;  // chi-square of a closure after solving; beyond it is taken out

  matching::MatcherParams matcher;
  matching::ObservabilityParams observability;
  matching::CorrelativeParams correlative;
  mapping::OccupancyMapperParams map;

  template <class V>
  static void visit(FusionParams& p, V&& v);
  [[nodiscard]] std::vector<std::string> relations() const;

 private:
  template <class V>
  static void visit_structure(FusionParams& p, V& v);
  template <class V>
  static void visit_sensors(FusionParams& p, V& v);
  template <class V>
  static void visit_tracking(FusionParams& p, V& v);
  template <class V>
  static void visit_loops(FusionParams& p, V& v);
};

// The published method, as facts about it are read: scalar degeneracy test, slip threshold,
// matching between consecutive key scans, no wheel calibration, no loop closing.
FusionParams fusion_paper_params();
// The same, but the LiDAR is left out per direction: what the scalar test costs.
FusionParams fusion_paper_with_directions();

template <class V>
void FusionParams::visit_structure(FusionParams& p, V& v) {
  using I = ParamInfo;
  v(I{"use_directional_degeneracy", "",
      "LiDAR factors only along the directions the scan constrains; false: the paper's scalar "
      "test"},
    p.use_directional_degeneracy);
  v(I{"use_statistical_slip_test", "", "slip by a chi-square test; false: the paper's threshold"},
    p.use_statistical_slip_test);
  v(I{"use_submaps", "", "match against a submap; false: against the last key scan"},
    p.use_submaps);
  v(I{"use_submap_refinement", "",
      "match the key scans of a finished submap once more, against all of it; needs use_submaps"},
    p.use_submap_refinement);
  v(I{"use_wheel_scale", "", "estimate the common scale error of the wheels"}, p.use_wheel_scale);
  v(I{"use_wheel_turn", "",
      "estimate the turn that unequal wheels hide and the error of the track"},
    p.use_wheel_turn);
  v(I{"use_wheel_delay", "", "estimate the delay of the wheels' clock against the LiDAR's"},
    p.use_wheel_delay);
  v(I{"use_axle_pose", "", "estimate where the wheels' axle lies in the frame of the LiDAR's base"},
    p.use_axle_pose);
  v(I{"use_gyro_scale", "", "estimate the scale error of the gyro"}, p.use_gyro_scale);
  v(I{"use_majority_vote", "",
      "leave the LiDAR out along directions in which wheels and IMU both contradict it"},
    p.use_majority_vote);
  v(I{"use_loop_closing", "", "search for and add loop closures"}, p.use_loop_closing);
  v(I{"use_wheels", "", "false: drive as if the robot had no wheel encoders"}, p.use_wheels);
  v(I{"use_imu", "", "false: drive as if the robot had no IMU"}, p.use_imu);
  v(I{"key_distance_m", "m", "travel between key scans", 0.01, 10}, p.key_distance_m);
  v(I{"key_angle_rad", "rad", "turn between key scans", 0.01, 3.2}, p.key_angle_rad);
  v(I{"key_interval_s", "s", "longest time between key scans of a moving robot with an IMU", 0.05,
      100},
    p.key_interval_s);
  v(I{"max_range_m", "m", "longer ranges are not used", 0.5, 1000}, p.max_range_m);
  v(I{"fine_resolution_m", "m", "cell of the fine surfel grid", 0.02, 1}, p.fine_resolution_m);
  v(I{"coarse_resolution_m", "m", "cell of the coarse surfel grid", 0.05, 4},
    p.coarse_resolution_m);
  v(I{"submap_key_scans", "1", "key scans in a submap", 2, 1000}, p.submap_key_scans);
}

template <class V>
void FusionParams::visit_sensors(FusionParams& p, V& v) {
  using I = ParamInfo;
  v(I{"wheel_translation_floor_m", "m", "smallest standard deviation of a wheel displacement", 1e-5,
      1},
    p.wheel_translation_floor_m);
  v(I{"wheel_translation_ratio", "1", "error of a wheel displacement as a share of it", 0, 1},
    p.wheel_translation_ratio);
  v(I{"wheel_rotation_floor_rad", "rad", "smallest standard deviation of a wheel rotation", 1e-5,
      1},
    p.wheel_rotation_floor_rad);
  v(I{"wheel_rotation_per_m_rad", "rad/m", "error of a wheel rotation per path", 0, 1},
    p.wheel_rotation_per_m_rad);
  v(I{"wheel_rotation_ratio", "1", "error of a wheel rotation as a share of it", 0, 1},
    p.wheel_rotation_ratio);
  v(I{"wheel_scale_sigma", "1",
      "standard deviation of the wheels' scale error before it is measured", 1e-6, 1},
    p.wheel_scale_sigma);
  v(I{"wheel_unbalance_sigma_radpm", "rad/m",
      "the same for the turn that unequal wheels hide, per path", 1e-6, 1},
    p.wheel_unbalance_sigma_radpm);
  v(I{"wheel_turn_sigma", "1", "the same for the share by which the track misjudges a turn", 1e-6,
      1},
    p.wheel_turn_sigma);
  v(I{"wheel_delay_sigma_s", "s", "the same for the delay of the wheels' clock", 1e-6, 0.2},
    p.wheel_delay_sigma_s);
  v(I{"axle_position_sigma_m", "m", "the same for the place of the axle's middle in the base", 1e-6,
      1},
    p.axle_position_sigma_m);
  v(I{"axle_heading_sigma_rad", "rad", "the same for the axle's heading in the base", 1e-6, 1},
    p.axle_heading_sigma_rad);
  v(I{"gyro_scale_sigma", "1", "the same for the gyro's scale error", 1e-6, 1}, p.gyro_scale_sigma);
  v(I{"calibration_interval_m", "m", "path from one state of the wheels' calibration to the next",
      0.1, 1e6},
    p.calibration_interval_m);
  v(I{"calibration_walk_ratio", "1", "its change over that path, as a share of the priors", 0, 1},
    p.calibration_walk_ratio);
  v(I{"max_wheel_noise_factor", "1",
      "limit of the adaptation of the wheel noise to what the LiDAR shows", 1, 1e4},
    p.max_wheel_noise_factor);
  v(I{"initial_velocity_sigma_mps", "m/s", "prior on the first velocity, around 0", 1e-3, 100},
    p.initial_velocity_sigma_mps);
  v(I{"gyro_bias_sigma_radps", "rad/s", "prior on the gyro bias, around 0", 1e-6, 1},
    p.gyro_bias_sigma_radps);
  v(I{"accel_bias_sigma_mps2", "m/s^2", "prior on the accelerometer bias, around 0", 1e-6, 10},
    p.accel_bias_sigma_mps2);
  v(I{"velocity_sigma_mps", "m/s", "error of the estimated velocity in the slip test", 1e-4, 1},
    p.velocity_sigma_mps);
  v(I{"slip_gate", "1", "chi-square above which the wheels are left out", 1, 1e4}, p.slip_gate);
  v(I{"slip_threshold_m", "m", "the paper's slip test: largest difference of IMU and wheels", 1e-3,
      10},
    p.slip_threshold_m);
  v(I{"degeneracy_floor_factor", "1",
      "the paper's LiDAR test: threshold over the measure's noise floor", 0, 100},
    p.degeneracy_floor_factor);
  v(I{"degeneracy_travel_m", "m", "the paper's LiDAR test: travel between the compared scans", 0.01,
      10},
    p.degeneracy_travel_m);
  v(I{"lidar_sigma_m", "m", "the paper's LiDAR constraint: standard deviation", 1e-4, 1},
    p.lidar_sigma_m);
  v(I{"lidar_sigma_rad", "rad", "the paper's LiDAR constraint: standard deviation", 1e-5, 1},
    p.lidar_sigma_rad);
}

template <class V>
void FusionParams::visit_tracking(FusionParams& p, V& v) {
  using I = ParamInfo;
  v(I{"match_prior_sigma_m", "m", "least width of the prediction while matching near it", 1e-3, 10},
    p.match_prior_sigma_m);
  v(I{"match_prior_sigma_rad", "rad", "least width of the prediction while matching near it", 1e-3,
      3},
    p.match_prior_sigma_rad);
  v(I{"hold_unseen_passes", "1",
      "further matches, each held at the prediction along what the last did not see", 0, 10},
    p.hold_unseen_passes);
  v(I{"vote_gate", "1", "chi-square along a direction beyond which a sensor contradicts the LiDAR",
      1, 1e4},
    p.vote_gate);
  v(I{"jump_inlier_ratio", "1",
      "smallest share of explained points of a match that contradicts the prediction", 0, 1},
    p.jump_inlier_ratio);
  v(I{"retry_inlier_ratio", "1",
      "with fewer explained points a match is sought further away: on the coarse surfels, then in "
      "the window",
      0, 1},
    p.retry_inlier_ratio);
  v(I{"retry_gain_ratio", "1", "share of the points that it must explain beyond the near match", 0,
      1},
    p.retry_gain_ratio);
  v(I{"retry_prior_sigma_m", "m", "least width of the prediction on the coarse surfels", 1e-3, 10},
    p.retry_prior_sigma_m);
  v(I{"retry_prior_sigma_rad", "rad", "least width of the prediction on the coarse surfels", 1e-3,
      3},
    p.retry_prior_sigma_rad);
  v(I{"retry_window_m", "m", "half width of the window", 0, 10}, p.retry_window_m);
  v(I{"retry_window_rad", "rad", "half width of that window", 0, 3.2}, p.retry_window_rad);
}

template <class V>
void FusionParams::visit_loops(FusionParams& p, V& v) {
  using I = ParamInfo;
  v(I{"loop_min_path_m", "m", "path before a place can count as seen again", 1, 1e4},
    p.loop_min_path_m);
  v(I{"loop_interval_m", "m", "travel between two searches", 0.01, 100}, p.loop_interval_m);
  v(I{"loop_radius_m", "m", "distance to a key scan of a submap that makes it a candidate", 0.1,
      100},
    p.loop_radius_m);
  v(I{"loop_drift_ratio", "1", "search window per path since the last closure", 0, 1},
    p.loop_drift_ratio);
  v(I{"loop_max_window_m", "m", "largest half width of the search", 0.1, 50}, p.loop_max_window_m);
  v(I{"loop_max_window_rad", "rad", "largest half width of the search", 0.01, 3.2},
    p.loop_max_window_rad);
  v(I{"loop_min_inlier_ratio", "1",
      "smallest share of explained points of a closure found by search", 0, 1},
    p.loop_min_inlier_ratio);
  v(I{"loop_min_agreeing", "1", "closures found by search that must agree in pairs", 1, 100},
    p.loop_min_agreeing);
  v(I{"loop_min_span_m", "m", "path along which those are spread at least", 0, 100},
    p.loop_min_span_m);
  v(I{"loop_memory_m", "m", "path after which a closure that waits is forgotten", 0, 1e4},
    p.loop_memory_m);
  v(I{"loop_agreement_m", "m",
      "difference at which two closures still agree, beside the drift between them", 0, 10},
    p.loop_agreement_m);
  v(I{"loop_agreement_rad", "rad",
      "difference at which two closures still agree, beside the drift between them", 0, 3.2},
    p.loop_agreement_rad);
  v(I{"loop_link_m", "m",
      "path from the newest closure on which key scans are matched against old submaps directly", 0,
      100},
    p.loop_link_m);
  v(I{"loop_sigma_m", "m", "error of a submap's shape, beside a closure's own", 1e-6, 1},
    p.loop_sigma_m);
  v(I{"loop_sigma_rad", "rad", "error of a submap's shape, beside a closure's own", 1e-6, 1},
    p.loop_sigma_rad);
  v(I{"loop_gate", "1", "chi-square beyond which a closure is taken out after solving", 1, 1e6},
    p.loop_gate);
}

template <class V>
void FusionParams::visit(FusionParams& p, V&& v) {
  visit_structure(p, v);
  visit_sensors(p, v);
  visit_tracking(p, v);
  visit_loops(p, v);
  matching::MatcherParams::visit(p.matcher, v);
  matching::ObservabilityParams::visit(p.observability, v);
  matching::CorrelativeParams::visit(p.correlative, v);
  mapping::OccupancyMapperParams::visit(p.map, v);
}

}  // namespace corridor::fusion
