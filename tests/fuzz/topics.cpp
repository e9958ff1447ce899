// LOG.topics.toml.
#include "datasets/formats/bag/bag_topics.hpp"

#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool topics(std::string_view bytes) {
  return formats::bag_topics_from_toml(bytes, "log.topics.toml").has_value();
}

}  // namespace corridor::fuzz
