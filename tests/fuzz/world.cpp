// Worlds: the corridor's keys or a drawing. A world that was read can be written and read again.
#include "datasets/simulation/world.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool world(std::string_view bytes) {
  const MemoryFile file(bytes);
  const auto read = simulation::read_world(file.path());
  if (!read) return false;
  simulation::outlines_m(*read);
  const MemoryFile written(simulation::world_toml(*read), MemoryFile::kSecond);
  const auto again = simulation::read_world(written.path());
  CORRIDOR_EXPECT(again.has_value() && again->num_surfaces() == read->num_surfaces());
  return true;
}

}  // namespace corridor::fuzz
