// Small ROS 1 bags for the tests of their reader, written by rosbag itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/formats/bag/rosbag_door.hpp"

namespace corridor::formats::test {

// Scans of 5 beams at 10 Hz on /scan, odometry on /odom and IMU on /imu at 50 Hz; stamped from
// 100 s on and recorded 1 ms later.
std::vector<ros1::Message> small_bag();

ros1::Message scan_message(std::int64_t stamp_ns);
ros1::Message odometry_message(std::int64_t stamp_ns);
ros1::Message imu_message(std::int64_t stamp_ns);

void write_bag(const std::filesystem::path& path, const std::vector<ros1::Message>& messages,
               ros1::Compression compression = ros1::Compression::kNone);

// The bytes that rosbag writes for `messages`, in chunks of about 2 kB.
std::string bag_bytes(const std::vector<ros1::Message>& messages,
                      ros1::Compression compression = ros1::Compression::kNone);

}  // namespace corridor::formats::test
