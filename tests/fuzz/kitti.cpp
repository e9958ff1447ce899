// KITTI trajectories: the poses, the separator, the stamps. What was read can be written and read
// again.
#include "datasets/formats/trajectories/trajectory_texts.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool kitti(std::string_view bytes) {
  const auto [poses, times] = split(bytes);
  const auto read = formats::parse_kitti(poses, "a.kitti", times, "a.times");
  if (!read) return false;
  const auto again = formats::parse_kitti(formats::kitti_text(read->trajectory), "a.kitti",
                                          formats::times_text(read->trajectory), "a.times");
  CORRIDOR_EXPECT(again.has_value() && again->trajectory.size() == read->trajectory.size());
  return true;
}

}  // namespace corridor::fuzz
