// ROS maps: the yaml, the separator, the image, which the yaml names "101".
#include "datasets/formats/maps/ros_map.hpp"

#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool ros_map(std::string_view bytes) {
  const auto [yaml, image] = split(bytes);
  const MemoryFile yaml_file(yaml);
  const MemoryFile image_file(image, MemoryFile::kSecond);
  return formats::read_ros_map(yaml_file.path()).has_value();
}

}  // namespace corridor::fuzz
