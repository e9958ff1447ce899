// Bags through rosbag, which opens a file: LOG.topics.toml, the separator, the bag. What the
// framing check lets in, rosbag must read.
#include "datasets/formats/bag/bag.hpp"

#include <string>

#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool bag(std::string_view bytes) {
  const auto [toml, log] = split(bytes);
  const auto topics = formats::bag_topics_from_toml(toml, "log.topics.toml");
  if (!topics) return false;
  const MemoryFile file(log);
  for (const bool keeps_record_order : {false, true}) {
    const auto parsed = formats::parse_bag(log, file.path(), {*topics, keeps_record_order});
    if (!parsed) return false;
    settle(*parsed);
  }
  return true;
}

}  // namespace corridor::fuzz
