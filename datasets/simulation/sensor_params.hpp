// The parameters of the simulated sensors, with their defaults: the suite's robot, whose sensors
// are honest but simple. Every error that is 0 by default can be turned on; a preset turns on those
// of a data sheet.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::simulation {

// How readings get from a sensor into the log.
struct MessageParams {
  double time_jitter_s = 0;
  double loss_ratio = 0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"time_jitter_s", "s",
                "standard deviation of each stamp's own error; stamps stay in order", 0, 0.1},
      p.time_jitter_s);
    v(ParamInfo{"loss_ratio", "1", "share of readings that never arrive", 0, 0.9}, p.loss_ratio);
  }
};

// Beam i points to yaw - fov / 2 + fov (i + 1/2) / num_beams in the base frame, counter-clockwise.
struct LidarParams {
  double rate_hz = 10;
  int num_beams = 360;
  double field_of_view_deg = 360;
  double x_m = 0, y_m = 0, yaw_deg = 0;
  double range_min_m = 0.05;
  double range_max_m = 4.5;
  double range_sigma_m = 0.015;
  double range_sigma_ratio = 0;
  double range_sigma_incidence_m = 0;
  double range_step_m = 0;
  double beam_width_deg = 0;
  double mixed_pixel_ratio = 0;
  double dropout_ratio = 0;
  double scan_duration_s = 0;
  double time_offset_s = 0;
  double time_offset_sigma_s = 0;
  MessageParams message = {};

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz", "scans per second; a whole multiple of it is the IMU's rate", 0.1,
                100},
      p.rate_hz);
    v(ParamInfo{"num_beams", "1", "beams per scan", 4, 100000}, p.num_beams);
    v(ParamInfo{"field_of_view_deg", "deg", "angle that the beams share out", 10, 360},
      p.field_of_view_deg);
    v(ParamInfo{"x_m", "m", "where it is mounted, ahead of the axle's middle", -2, 2}, p.x_m);
    v(ParamInfo{"y_m", "m", "where it is mounted, to the left", -2, 2}, p.y_m);
    v(ParamInfo{"yaw_deg", "deg", "where the middle of its view points, counter-clockwise", -180,
                180},
      p.yaw_deg);
    v(ParamInfo{"range_min_m", "m", "nearer walls give no return", 0, 10}, p.range_min_m);
    v(ParamInfo{"range_max_m", "m", "farther walls give no return; the raw range is then 1 m more",
                0.1, 1000},
      p.range_max_m);
    v(ParamInfo{"range_sigma_m", "m", "white noise of a range, standard deviation", 0, 1},
      p.range_sigma_m);
    v(ParamInfo{"range_sigma_ratio", "1", "further noise, as a part of the range", 0, 0.2},
      p.range_sigma_ratio);
    v(ParamInfo{"range_sigma_incidence_m", "m",
                "further noise times the tangent of the angle to the wall's normal (at most 10)", 0,
                0.5},
      p.range_sigma_incidence_m);
    v(ParamInfo{"range_step_m", "m", "ranges are rounded to whole steps; 0 = not", 0, 0.5},
      p.range_step_m);
    v(ParamInfo{"beam_width_deg", "deg", "full width of a beam; 0 = a line", 0, 5},
      p.beam_width_deg);
    v(ParamInfo{"mixed_pixel_ratio", "1",
                "share of the beams that meet two surfaces and read a range between them", 0, 1},
      p.mixed_pixel_ratio);
    v(ParamInfo{"dropout_ratio", "1", "share of the beams that return nothing though they should",
                0, 1},
      p.dropout_ratio);
    v(ParamInfo{"scan_duration_s", "s", "from the first beam to the last; 0 = all at once", 0, 10},
      p.scan_duration_s);
    v(ParamInfo{"time_offset_s", "s", "the LiDAR's clock minus the wheels', as the log states it",
                -1, 1},
      p.time_offset_s);
    v(ParamInfo{"time_offset_sigma_s", "s",
                "standard deviation of what the log does not state of that offset, one per log", 0,
                1},
      p.time_offset_sigma_s);
    MessageParams::visit(p.message, v);
  }
  std::vector<std::string> relations() const;
};

// Nominal mounting.
Pose2 T_base_lidar(const LidarParams& params);

// One figure for all that spreads the ranges of plain surfaces: what a log states as
// lidar.range_sigma_m. The root of the sum of squares of range_sigma_m, of range_sigma_ratio at
// half of range_max_m but at most at 4 m, of range_sigma_incidence_m at 45 degrees, and of
// range_step_m / sqrt(12). Without the last three it is range_sigma_m. Mixed pixels and motion
// during the sweep are no part of it.
double stated_range_sigma_m(const LidarParams& params);

// Wheel encoders. recorded path = true path of the turning wheel x scale x (1 + white noise), in
// ticks. left scale = 1 + e + u, right scale = 1 + e - u, and the true track is
// track_m x (1 + t), constant per log.
struct WheelParams {
  // noise_ratio is said of steps of 5 ms, those of an IMU of the suite's robot.
  static constexpr double kNoiseRate_hz = 200;

  double rate_hz = 50;
  double m_per_tick = 1e-4;
  double track_m = 0.35;
  double noise_ratio = 0.02;
  double scale_sigma = 0.01;
  double unbalance_sigma = 0.005;
  double track_sigma = 0;
  MessageParams message = {};

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz", "samples per second; a whole fraction of the IMU's rate", 0.1,
                1000},
      p.rate_hz);
    v(ParamInfo{"m_per_tick", "m", "path of the wheel's rim per tick", 1e-7, 0.1}, p.m_per_tick);
    v(ParamInfo{"track_m", "m", "distance between the wheels as the log states it", 0.05, 2},
      p.track_m);
    v(ParamInfo{"noise_ratio", "1", "white noise of each 5 ms of path, as a part of it", 0, 1},
      p.noise_ratio);
    v(ParamInfo{"scale_sigma", "1", "standard deviation of the scale error e of both wheels", 0,
                0.2},
      p.scale_sigma);
    v(ParamInfo{"unbalance_sigma", "1", "standard deviation of the unbalance u of the wheels", 0,
                0.2},
      p.unbalance_sigma);
    v(ParamInfo{"track_sigma", "1", "standard deviation of the track's relative error t", 0, 0.2},
      p.track_sigma);
    MessageParams::visit(p.message, v);  // ticks go on counting while messages are lost
  }

  // Of a step of another length the part is such that a path has the same noise, however many steps
  // it is made of.
  [[nodiscard]] double step_noise_ratio(double step_s) const {
    return noise_ratio * std::sqrt(1 / (kNoiseRate_hz * step_s));
  }
  // Steps of length d add (noise_ratio * d)^2 per d of path: noise_ratio * sqrt(d) per root metre.
  [[nodiscard]] double noise_m_per_sqrt_m(double speed_mps) const {
    return noise_ratio * std::sqrt(speed_mps / kNoiseRate_hz);
  }
};

// IMU. reading = M (truth + gravity's share + vibration) + bias(t) + white noise, M = scale and
// misalignment. Its noise in Allan-variance figures [IEEE952]: N the white noise's density, B the
// bias instability (the flat bottom of the Allan deviation is 0.664 B), K the random walk.
struct ImuParams {
  double rate_hz = 200;
  double x_m = 0, y_m = 0, yaw_deg = 0;
  double gyro_noise_radps_rthz = 7.0710678118654752e-4;  // 0.01 rad/s per sample at 200 Hz
  double accel_noise_mps2_rthz = 3.5355339059327376e-3;  // 0.05 m/s2 per sample at 200 Hz
  double gyro_instability_radps = 0;
  double accel_instability_mps2 = 0;
  double gyro_walk_radps_rts = 0;
  double accel_walk_mps2_rts = 0;
  double gyro_bias_sigma_radps = 0.003;
  double accel_bias_sigma_mps2 = 0.03;
  double gyro_scale_sigma = 0;
  double accel_scale_sigma = 0;
  double misalignment_sigma_deg = 0;
  double tilt_sigma_deg = 0;
  double tilt_length_m = 2;
  double vibration_mps2 = 0;
  double time_offset_sigma_s = 0;
  MessageParams message = {};

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"rate_hz", "Hz",
                "samples per second, and the rate at which the drive is integrated", 10, 10000},
      p.rate_hz);
    v(ParamInfo{"x_m", "m", "where it is mounted, ahead of the axle's middle", -2, 2}, p.x_m);
    v(ParamInfo{"y_m", "m", "where it is mounted, to the left", -2, 2}, p.y_m);
    v(ParamInfo{"yaw_deg", "deg", "where its x axis points, counter-clockwise", -180, 180},
      p.yaw_deg);
    v(ParamInfo{"gyro_noise_radps_rthz", "rad/s/rtHz", "N: white noise density", 0, 0.1},
      p.gyro_noise_radps_rthz);
    v(ParamInfo{"accel_noise_mps2_rthz", "m/s2/rtHz", "N: white noise density per axis", 0, 1},
      p.accel_noise_mps2_rthz);
    v(ParamInfo{"gyro_instability_radps", "rad/s", "B: bias instability", 0, 0.1},
      p.gyro_instability_radps);
    v(ParamInfo{"accel_instability_mps2", "m/s2", "B: bias instability per axis", 0, 1},
      p.accel_instability_mps2);
    v(ParamInfo{"gyro_walk_radps_rts", "rad/s/rts", "K: random walk of the bias", 0, 0.1},
      p.gyro_walk_radps_rts);
    v(ParamInfo{"accel_walk_mps2_rts", "m/s2/rts", "K: random walk of the bias per axis", 0, 1},
      p.accel_walk_mps2_rts);
    v(ParamInfo{"gyro_bias_sigma_radps", "rad/s",
                "standard deviation of the bias that is constant per log", 0, 1},
      p.gyro_bias_sigma_radps);
    v(ParamInfo{"accel_bias_sigma_mps2", "m/s2",
                "standard deviation of each axis's bias that is constant per log", 0, 10},
      p.accel_bias_sigma_mps2);
    v(ParamInfo{"gyro_scale_sigma", "1", "standard deviation of the scale error", 0, 0.2},
      p.gyro_scale_sigma);
    v(ParamInfo{"accel_scale_sigma", "1", "standard deviation of each axis's scale error", 0, 0.2},
      p.accel_scale_sigma);
    v(ParamInfo{"misalignment_sigma_deg", "deg",
                "standard deviation of what the mounting's yaw is off", 0, 10},
      p.misalignment_sigma_deg);
    v(ParamInfo{"tilt_sigma_deg", "deg",
                "standard deviation of the floor's slopes along x and y, through which gravity "
                "leaks in",
                0, 5},
      p.tilt_sigma_deg);
    v(ParamInfo{"tilt_length_m", "m", "path over which the floor's tilt changes", 0.05, 100},
      p.tilt_length_m);
    v(ParamInfo{"vibration_mps2", "m/s2",
                "vibration at 1 m/s, standard deviation per axis, grows with the speed", 0, 50},
      p.vibration_mps2);
    v(ParamInfo{"time_offset_sigma_s", "s",
                "standard deviation of its clock minus the wheels', one per log", 0, 1},
      p.time_offset_sigma_s);
    MessageParams::visit(p.message, v);
  }
  // White noise of one reading, standard deviation.
  [[nodiscard]] double gyro_noise_radps() const;
  [[nodiscard]] double accel_noise_mps2() const;
};

}  // namespace corridor::simulation
