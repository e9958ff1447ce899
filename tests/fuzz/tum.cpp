// TUM trajectories; what was read can be written and read again.
#include "datasets/formats/trajectories/tum.hpp"

#include "datasets/formats/trajectories/trajectory_texts.hpp"
#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool tum(std::string_view bytes) {
  const auto read = formats::parse_tum_trajectory(bytes, "a.tum");
  if (!read) return false;
  const auto again = formats::parse_tum_trajectory(formats::tum_text(read->trajectory), "a.tum");
  CORRIDOR_EXPECT(again.has_value() && again->trajectory.size() == read->trajectory.size());
  return true;
}

}  // namespace corridor::fuzz
