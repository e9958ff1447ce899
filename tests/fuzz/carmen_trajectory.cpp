// Poses of CARMEN logs; what was read can be written and read again.
#include "datasets/formats/trajectories/trajectory_texts.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool carmen_trajectory(std::string_view bytes) {
  const auto read = formats::parse_carmen_trajectory(bytes, "a.clf");
  if (!read) return false;
  const auto again =
      formats::parse_carmen_trajectory(formats::carmen_trajectory_text(read->trajectory), "a.clf");
  CORRIDOR_EXPECT(again.has_value() && again->trajectory.size() == read->trajectory.size());
  return true;
}

}  // namespace corridor::fuzz
