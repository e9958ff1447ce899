// The parameters of a scenario, one struct per cause, with their defaults: the suite's robot.
// It does not read files; scenario.hpp does.
#pragma once

#include <string>
#include <vector>

#include "datasets/simulation/world.hpp"
#include "slam/core/params.hpp"

namespace corridor::simulation {

// The [world] table: CorridorShape as files spell it. Its defaults are those of CorridorShape.
struct WorldParams {
  double a_m, b_m, c_m, alpha_deg, doors_every_m;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"a_m", "m", "length of the right outer wall"}, p.a_m);
    v(ParamInfo{"b_m", "m", "length of the lower outer wall"}, p.b_m);
    v(ParamInfo{"c_m", "m", "width of the corridor"}, p.c_m);
    v(ParamInfo{"alpha_deg", "deg", "interior angle between the two outer walls"}, p.alpha_deg);
    v(ParamInfo{"doors_every_m", "m", "period of the door recesses; 0 = none"}, p.doors_every_m);
  }
};
WorldParams to_params(const CorridorShape& shape);
CorridorShape to_shape(const WorldParams& params);

// Instant scans all around; beam i points to -pi + 2 pi (i + 1/2) / num_beams in the base frame.
struct LidarParams {
  double rate_hz = 10;
  int num_beams = 360;
  double range_min_m = 0.05;
  double range_max_m = 4.5;
  double range_sigma_m = 0.015;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz", "scans per second; a whole multiple of it is the IMU's rate", 0.1,
                100},
      p.rate_hz);
    v(ParamInfo{"num_beams", "1", "beams per turn", 4, 100000}, p.num_beams);
    v(ParamInfo{"range_min_m", "m", "nearer walls give no return", 0, 10}, p.range_min_m);
    v(ParamInfo{"range_max_m", "m", "farther walls give no return; the raw range is then 1 m more",
                0.1, 1000},
      p.range_max_m);
    v(ParamInfo{"range_sigma_m", "m", "white noise of a range, standard deviation", 0, 1},
      p.range_sigma_m);
  }
  std::vector<std::string> relations() const;
};

// Wheel encoders. recorded path = true path of the turning wheel x scale x (1 + white noise), in
// ticks. left scale = 1 + e + u, right scale = 1 + e - u, constant per log.
struct WheelParams {
  double rate_hz = 50;
  double m_per_tick = 1e-4;
  double track_m = 0.35;
  double noise_ratio = 0.02;
  double scale_sigma = 0.01;
  double unbalance_sigma = 0.005;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz", "samples per second; a whole fraction of the IMU's rate", 0.1,
                1000},
      p.rate_hz);
    v(ParamInfo{"m_per_tick", "m", "path of the wheel's rim per tick", 1e-7, 0.1}, p.m_per_tick);
    v(ParamInfo{"track_m", "m", "distance between the wheels", 0.05, 2}, p.track_m);
    v(ParamInfo{"noise_ratio", "1", "white noise of each IMU-rate step's path, as a part of it", 0,
                1},
      p.noise_ratio);
    v(ParamInfo{"scale_sigma", "1", "standard deviation of the scale error e of both wheels", 0,
                0.2},
      p.scale_sigma);
    v(ParamInfo{"unbalance_sigma", "1", "standard deviation of the unbalance u of the wheels", 0,
                0.2},
      p.unbalance_sigma);
  }
};

// IMU at the base's origin. reading = truth + constant bias + white noise.
struct ImuParams {
  double rate_hz = 200;
  double gyro_noise_radps = 0.01;
  double accel_noise_mps2 = 0.05;
  double gyro_bias_sigma_radps = 0.003;
  double accel_bias_sigma_mps2 = 0.03;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz",
                "samples per second, and the rate at which the drive is integrated", 10, 10000},
      p.rate_hz);
    v(ParamInfo{"gyro_noise_radps", "rad/s", "white noise per sample", 0, 1}, p.gyro_noise_radps);
    v(ParamInfo{"accel_noise_mps2", "m/s2", "white noise per sample and axis", 0, 10},
      p.accel_noise_mps2);
    v(ParamInfo{"gyro_bias_sigma_radps", "rad/s",
                "standard deviation of the bias, constant per log", 0, 1},
      p.gyro_bias_sigma_radps);
    v(ParamInfo{"accel_bias_sigma_mps2", "m/s2",
                "standard deviation of each axis's bias, constant per log", 0, 10},
      p.accel_bias_sigma_mps2);
  }
};

// The drive: from end_margin_m before the left end along the first arm, around the corner, to
// end_margin_m before the top end. The robot heads for one waypoint after the other.
struct DriveParams {
  double speed_min_mps = 0.4;
  double speed_max_mps = 0.6;
  double acceleration_mps2 = 0.5;
  double yaw_rate_max_radps = 0.8;
  double yaw_acceleration_radps2 = 4;
  double heading_gain_per_s = 1.5;
  double turn_in_place_deg = 35;
  double waypoint_reach_m = 0.2;
  double end_margin_m = 2.5;
  double start_spread_m = 0.3;
  double heading_spread_deg = 20;
  double lateral_spread_m = 0.4;
  int num_arm_waypoints = 0;
  bool is_return_trip = false;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"speed_min_mps", "m/s", "lower end of the drawn cruising speed", 0.01, 5},
      p.speed_min_mps);
    v(ParamInfo{"speed_max_mps", "m/s", "upper end of the drawn cruising speed", 0.01, 5},
      p.speed_max_mps);
    v(ParamInfo{"acceleration_mps2", "m/s2", "limit of acceleration and braking", 0.01, 10},
      p.acceleration_mps2);
    v(ParamInfo{"yaw_rate_max_radps", "rad/s", "limit of the yaw rate", 0.01, 10},
      p.yaw_rate_max_radps);
    v(ParamInfo{"yaw_acceleration_radps2", "rad/s2", "limit of the yaw acceleration", 0.1, 100},
      p.yaw_acceleration_radps2);
    v(ParamInfo{"heading_gain_per_s", "1/s", "commanded yaw rate per heading error", 0.1, 10},
      p.heading_gain_per_s);
    v(ParamInfo{"turn_in_place_deg", "deg", "larger heading errors make the robot stop and turn", 5,
                90},
      p.turn_in_place_deg);
    v(ParamInfo{"waypoint_reach_m", "m", "a waypoint this near counts as reached", 0.05, 1},
      p.waypoint_reach_m);
    v(ParamInfo{"end_margin_m", "m",
                "distance of the first and the last waypoint from the end walls", 1, 100},
      p.end_margin_m);
    v(ParamInfo{"start_spread_m", "m", "half range of the drawn start position, along and across",
                0, 5},
      p.start_spread_m);
    v(ParamInfo{"heading_spread_deg", "deg", "half range of the drawn start heading", 0, 180},
      p.heading_spread_deg);
    v(ParamInfo{"lateral_spread_m", "m",
                "half range of each waypoint's drawn offset across the arm", 0, 5},
      p.lateral_spread_m);
    v(ParamInfo{"num_arm_waypoints", "1", "waypoints inside each arm, evenly spaced; 0 = straight",
                0, 100},
      p.num_arm_waypoints);
    v(ParamInfo{"is_return_trip", "", "drives back to the start the same way, which closes a loop"},
      p.is_return_trip);
  }
  std::vector<std::string> relations() const;
};

// Intervals in which the wheels turn (1 + ratio) times as far as the robot moves; they never
// overlap.
struct SlipParams {
  int num_slips = 0;
  double duration_s = 1;
  double ratio = 0.6;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"num_slips", "1", "number of slips, at drawn times of the drive", 0, 1000},
      p.num_slips);
    v(ParamInfo{"duration_s", "s", "length of each", 0.01, 100}, p.duration_s);
    v(ParamInfo{"ratio", "1", "spin of the wheels as a part of the true path", -1, 10}, p.ratio);
  }
};

// What else each seed draws.
struct DrawParams {
  double length_spread = 0;
  double alpha_spread_deg = 0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"length_spread", "1", "half range of the drawn relative change of a, b and c", 0,
                0.5},
      p.length_spread);
    v(ParamInfo{"alpha_spread_deg", "deg", "half range of the drawn change of alpha", 0, 45},
      p.alpha_spread_deg);
  }
};

}  // namespace corridor::simulation
