// ROS 1 bags as events and back. Internal to this folder; log_io.hpp is the door.
// The stamp of a message's header counts; the time of its recording does not.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/bag/rosbag_door.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

struct BagOptions {
  BagTopics topics;
  // Events in the order of their recording, instead of one order of stamps over all topics.
  bool keeps_record_order = false;
};

// `bytes` is the file at `path`, whose framing is checked before rosbag opens it. Topics are
// streams of their own: each keeps its order, and they are merged by stamp; a stamp that steps back
// within a topic stays where it is, for stamp_order to refuse. Where sensors sit is the robot
// model's to say: transforms are left out and counted, like every topic that is not used.
// Ranges [REP 117]: beyond the limits, NaN and infinite mean no return; negative ones are an Error.
// Wheels from joints have ticks and no pose yet (ParsedLog::has_wheel_ticks_only).
Result<ParsedLog> parse_bag(std::string_view bytes, const std::filesystem::path& path,
                            const BagOptions& options);

// The messages of topics /scan, /odom and /imu; an Error if a stamp does not fit ROS time.
Result<std::vector<ros1::Message>> ros_messages(const SensorLog& log, const std::string& where);

// Topics /scan, /odom and /imu, LZ4; recorded when they are stamped. An Error if a stamp does not
// fit ROS time (unsigned 32-bit seconds).
Result<void> write_bag_file(const SensorLog& log, const std::filesystem::path& path);

}  // namespace corridor::formats
