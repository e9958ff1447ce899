// The check that comes before rosbag, chunks decompressed.
#include "datasets/formats/bag/bag_framing.hpp"

#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool bag_framing(std::string_view bytes) {
  return formats::check_bag_framing(bytes, "log.bag").has_value();
}

}  // namespace corridor::fuzz
