#include "tests/datasets/formats/lcm_support.hpp"

#include <bit>
#include <cmath>

namespace corridor::formats::test {

std::string big_endian(std::uint64_t value, int num_bytes) {
  std::string bytes;
  for (int i = num_bytes - 1; i >= 0; --i) bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
  return bytes;
}

std::string big_endian(float value) { return big_endian(std::bit_cast<std::uint32_t>(value), 4); }

namespace {

std::string u64(std::int64_t value) { return big_endian(static_cast<std::uint64_t>(value), 8); }
std::string u32(std::int32_t value) { return big_endian(static_cast<std::uint32_t>(value), 4); }
std::string u16(std::int16_t value) { return big_endian(static_cast<std::uint16_t>(value), 2); }

}  // namespace

std::string lcm_event(std::uint64_t number, std::int64_t utime_us, const std::string& channel,
                      const std::string& data) {
  return big_endian(0xEDA1DA01, 4) + big_endian(number, 8) + u64(utime_us) +
         big_endian(channel.size(), 4) + big_endian(data.size(), 4) + channel + data;
}

ScanBeams regular_beams(std::int64_t stamp_us, int num_beams) {
  ScanBeams beams;
  for (int i = 0; i < num_beams; ++i) {
    beams.ranges_m.push_back(1.0F + 0.01F * static_cast<float>(i));
    beams.angles_rad.push_back(static_cast<float>(2 * std::acos(-1) * i / num_beams));
    beams.times_us.push_back(stamp_us + 1000 * i);
  }
  return beams;
}

std::string scan_message(std::int64_t stamp_us, const ScanBeams& beams) {
  std::string data = big_endian(0x89dc5b879a5056cf, 8) + u64(stamp_us) +
                     u32(static_cast<std::int32_t>(beams.ranges_m.size()));
  for (const float range_m : beams.ranges_m) data += big_endian(range_m);
  for (const float angle_rad : beams.angles_rad) data += big_endian(angle_rad);
  for (const std::int64_t time_us : beams.times_us) data += u64(time_us);
  for (std::size_t i = 0; i < beams.ranges_m.size(); ++i) data += big_endian(0.5F);
  return data;
}

std::string ticks_message(std::int64_t stamp_us, std::int32_t left, std::int32_t right) {
  return big_endian(0x8dc5a028fca42ff9, 8) + u64(stamp_us) + u32(left) + u32(right) +
         std::string(24, '\0');
}

std::string imu_message(std::int64_t stamp_us, std::int16_t accel_x, std::int16_t accel_y,
                        std::int16_t gyro_z, std::int16_t accel_z) {
  return big_endian(0xc320824c265e849a, 8) + u64(stamp_us) + u16(accel_x) + u16(accel_y) +
         u16(accel_z) + u16(0) + u16(0) + u16(gyro_z) + std::string(24 + 18, '\0');
}

std::string pose_message(std::int64_t stamp_us, float x_m, float y_m, float theta_rad) {
  return big_endian(0x1f317af1246276ac, 8) + u64(stamp_us) + big_endian(x_m) + big_endian(y_m) +
         big_endian(theta_rad);
}

LcmLog& LcmLog::add(std::int64_t utime_us, const std::string& channel, const std::string& data) {
  bytes_ += lcm_event(number_++, utime_us, channel, data);
  return *this;
}

LcmLog small_lcm_log(std::int64_t board_ahead_us, std::int64_t jump_us) {
  constexpr std::int64_t kDelay_us = 500;
  constexpr std::int64_t kSweep_us = 39'000;  // of 40 beams, 1 ms each
  LcmLog log;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t now_us = 100'000'000 + 50'000LL * i + (i < 10 ? 0 : jump_us);
    log.add(now_us + kDelay_us, "MAEBOT_MOTOR_FEEDBACK",
            ticks_message(now_us + board_ahead_us, 100 * i, 100 * i));
    log.add(now_us + kDelay_us, "MAEBOT_SENSOR_DATA",
            imu_message(now_us + board_ahead_us, 1638, -1638, 131));
    if (i % 2 == 0) {
      log.add(now_us + kSweep_us + kDelay_us, "MAEBOT_LASER_SCAN",
              scan_message(now_us, regular_beams(now_us)));
    }
  }
  return log;
}

}  // namespace corridor::formats::test
