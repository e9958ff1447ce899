// The structure of a ROS 1 bag (V2.0), checked byte by byte before rosbag sees it: rosbag follows
// lengths, offsets and counts wherever they lead and allocates what they say.
//   file header ; chunks, each followed by the index of its messages ; connections ; chunk infos
// Checked: every record's lengths and fields, chunk compression and size, that each index entry
// leads to a message of its connection and time and each message has one, that connections and
// chunk infos say what the chunks hold, and the layout of every message of a type the suite reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::formats {

struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;  // "sensor_msgs/LaserScan"
  std::size_t num_messages = 0;
};

// One message, in the order of the file.
struct BagMessage {
  std::uint32_t connection_id = 0;
  std::int64_t record_ns = 0;  // when it was recorded, not its header's stamp
  // Its byte in the file; in a compressed chunk, the chunk's.
  std::uint64_t origin = 0;
};

struct BagIndex {
  std::vector<BagConnection> connections;  // in ascending order of their ids
  std::vector<BagMessage> messages;
};

// `bytes` is the whole file. The Error names the byte and what belongs there.
Result<BagIndex> check_bag_framing(std::string_view bytes, const std::string& file);

}  // namespace corridor::formats
