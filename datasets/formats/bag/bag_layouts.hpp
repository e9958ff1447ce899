// The ROS message types the suite reads, with the layout of their bytes: every length is checked
// before ROS allocates what it says. Values are not judged here. Internal to this folder.
#pragma once

#include <optional>
#include <string_view>

#include "datasets/formats/bag/bag_records.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

enum class BagType { kLaserScan, kOdometry, kImu, kJointState };

struct BagTypeInfo {
  BagType type;
  std::string_view name;  // "sensor_msgs/LaserScan"
  std::string_view md5;   // of its definition
};

// nullopt: a type the suite has no use for.
std::optional<BagTypeInfo> bag_type_of(std::string_view name);
const BagTypeInfo& bag_type_info(BagType type);

// The Error names the byte, in `from`, where the message [begin, end) leaves its layout.
Result<void> check_message_layout(BagType type, const BagBytes& from, std::size_t begin,
                                  std::size_t end);

}  // namespace corridor::formats
