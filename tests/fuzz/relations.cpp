// Relations.
#include "datasets/formats/trajectories/relations.hpp"

#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool relations(std::string_view bytes) {
  const MemoryFile file(bytes);
  return formats::read_relations(file.path()).has_value();
}

}  // namespace corridor::fuzz
