// The tables of a scenario, one after the other. Internal to this folder.
#pragma once

#include "datasets/simulation/scenario.hpp"

namespace corridor::simulation {

// Calls visitor(section name, parameter struct) for each table that holds plain parameters; [world]
// only where it is the paper's corridor.
template <class Visitor>
void for_each_section(Scenario& scenario, Visitor&& visitor) {
  if (scenario.world.corridor) {
    WorldParams world = to_params(*scenario.world.corridor);
    visitor("world", world);
    scenario.world.corridor = to_shape(world);
  }
  visitor("lidar", scenario.lidar);
  visitor("wheels", scenario.wheels);
  visitor("imu", scenario.imu);
  visitor("drive", scenario.drive);
  visitor("slip", scenario.slip);
  visitor("outages", scenario.outages);
  visitor("draw", scenario.draw);
  visitor("people", scenario.people);
}

}  // namespace corridor::simulation
