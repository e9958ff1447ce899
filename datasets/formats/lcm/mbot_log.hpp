// The messages of an mbot log, decoded and checked one by one, sensor by sensor. Clocks, units and
// geometry are the business of lcm_reader.cpp. Internal to this folder.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/lcm/mbot_messages.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/uniform_fan.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// A message with when the logger received it and where it stands.
template <class T>
struct Received {
  T message;
  std::int64_t utime_us = 0;
  std::size_t begin = 0;
};

struct MbotLog {
  std::vector<Received<Sweep>> sweeps;  // of the first LiDAR channel
  std::vector<Received<MbotTicks>> ticks;
  std::vector<Received<MbotImu>> imu;
  std::vector<Received<MbotPose>> poses;
  Counts counts;    // repairs
  Counts left_out;  // as in ParsedLog
};

// An Error names the byte of the first message that is unfit: another layout than expected, an
// absurd number of beams, ranges or angles that are not numbers, beam times that step back or that
// do not belong to the scan.
Result<MbotLog> read_mbot_log(std::string_view bytes, const std::string& file);

}  // namespace corridor::formats
