// Scenarios and families: the scenario, the separator, a map's yaml ("101"), the separator, its
// image
// ("102").
#include "datasets/simulation/scenario.hpp"

#include <algorithm>

#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {
namespace {

constexpr std::size_t kMaxMembers = 3;

void load_members(const std::string& name) {
  const auto members = simulation::scenario_members(name);
  if (!members) return;
  for (std::size_t i = 0; i < std::min(members->size(), kMaxMembers); ++i) {
    if (const auto scenario = simulation::load_scenario((*members)[i])) {
      simulation::nominal_robot(*scenario);
    }
  }
}

}  // namespace

bool scenario(std::string_view bytes) {
  const auto [toml, map] = split(bytes);
  const auto [yaml, image] = split(map);
  const MemoryFile file(toml);
  const MemoryFile yaml_file(yaml, MemoryFile::kSecond);
  const MemoryFile image_file(image, MemoryFile::kThird);
  const auto read = simulation::read_scenario(file.path());
  if (!read) return false;
  simulation::scenario_values(*read);
  load_members(file.path().string());
  return true;
}

}  // namespace corridor::fuzz
