// LCM event logs as lcm-logger writes them, made by hand: independent of the readers' code.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace corridor::formats::test {

// Big endian, as many bytes as asked for.
std::string big_endian(std::uint64_t value, int num_bytes);
std::string big_endian(float value);

// One event with its header.
std::string lcm_event(std::uint64_t number, std::int64_t utime_us, const std::string& channel,
                      const std::string& data);

struct ScanBeams {
  std::vector<float> ranges_m;
  std::vector<float> angles_rad;
  std::vector<std::int64_t> times_us;
};

// A turn of `num_beams` regular beams that begins at angle 0; range i is 1 + i/100 m, beam i is
// taken 1000 us * i after the stamp.
ScanBeams regular_beams(std::int64_t stamp_us, int num_beams = 40);

std::string scan_message(std::int64_t stamp_us, const ScanBeams& beams);
std::string ticks_message(std::int64_t stamp_us, std::int32_t left, std::int32_t right);
// z reads 1 g of 16384.
std::string imu_message(std::int64_t stamp_us, std::int16_t accel_x, std::int16_t accel_y,
                        std::int16_t gyro_z, std::int16_t accel_z = 16'384);
std::string pose_message(std::int64_t stamp_us, float x_m, float y_m, float theta_rad);

// Writes events with consecutive numbers.
class LcmLog {
 public:
  LcmLog& add(std::int64_t utime_us, const std::string& channel, const std::string& data);
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::uint64_t number_ = 0;
  std::string bytes_;
};

// One second of a robot that drives ahead: 10 scans, 20 readings of wheels and IMU with the stamps
// of their own clock, `board_ahead_us` later than the LiDAR's; received 500 us after they were
// taken.
// From the 11th reading on all clocks are `jump_us` later.
LcmLog small_lcm_log(std::int64_t board_ahead_us = 0, std::int64_t jump_us = 0);

}  // namespace corridor::formats::test
