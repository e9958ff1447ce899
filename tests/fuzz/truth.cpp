// LOG.truth.toml of simulated logs. A truth that was read can be written and read again.
#include "datasets/simulation/truth.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool truth(std::string_view bytes) {
  const MemoryFile file(bytes);
  const auto read = simulation::read_truth(file.path());
  if (!read) return false;
  CORRIDOR_EXPECT(read->T_world_base_start.is_finite());
  const std::string text = simulation::truth_toml(*read);
  const MemoryFile written(text, MemoryFile::kSecond);
  const auto again = simulation::read_truth(written.path());
  CORRIDOR_EXPECT(again.has_value() && simulation::truth_toml(*again) == text);
  return true;
}

}  // namespace corridor::fuzz
