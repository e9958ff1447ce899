// EuRoC trajectories; what was read can be written and read again.
#include "datasets/formats/trajectories/trajectory_texts.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool euroc(std::string_view bytes) {
  const auto read = formats::parse_euroc(bytes, "a.csv");
  if (!read) return false;
  const auto again = formats::parse_euroc(formats::euroc_text(read->trajectory), "a.csv");
  CORRIDOR_EXPECT(again.has_value() && again->trajectory.size() == read->trajectory.size());
  return true;
}

}  // namespace corridor::fuzz
