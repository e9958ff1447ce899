// The four messages of the mbot robot that the suite reads, as their senders defined them. Each
// begins with LCM's 8-byte fingerprint of its type: a message of another layout is refused, never
// reinterpreted. Values are judged by the reader. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/formats/lcm/lcm_framing.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// *_LASER_SCAN: i64 utime_us, i32 n, f32 range_m[n], f32 theta_rad[n], i64 time_us[n],
// f32 intensity[n]. Beams stand in the order they were taken; 0 = no return.
struct MbotScan {
  std::int64_t stamp_us = 0;
  std::vector<float> ranges_m;
  std::vector<float> angles_rad;
  std::vector<std::int64_t> times_us;
};

// MAEBOT_MOTOR_FEEDBACK: i64 utime_us, i32 left, right cumulative ticks, then six motor values.
struct MbotTicks {
  std::int64_t stamp_us = 0;
  std::int32_t left = 0;
  std::int32_t right = 0;
};

// MAEBOT_SENSOR_DATA: i64 utime_us, i16 accel[3], i16 gyro[3], i64 gyro_integral[3], then nine
// other readings.
struct MbotImu {
  std::int64_t stamp_us = 0;
  std::array<std::int16_t, 3> accel_lsb{};
  std::array<std::int16_t, 3> gyro_lsb{};
};

// MAEBOT_POSE: i64 utime_us, f32 x_m, y_m, theta_rad.
struct MbotPose {
  std::int64_t stamp_us = 0;
  float x_m = 0;
  float y_m = 0;
  float theta_rad = 0;
};

Result<MbotScan> decode_scan(const LcmEvent& event, const std::string& file);
Result<MbotTicks> decode_ticks(const LcmEvent& event, const std::string& file);
Result<MbotImu> decode_imu(const LcmEvent& event, const std::string& file);
Result<MbotPose> decode_pose(const LcmEvent& event, const std::string& file);

}  // namespace corridor::formats
