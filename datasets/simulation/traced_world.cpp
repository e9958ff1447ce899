// Occupancy map to walls.
#include "datasets/simulation/map_borders.hpp"
#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

World traced_world(const GridMap& map) {
  World world;
  const auto point_m = [&](const Eigen::Vector2i& corner) {
    return Eigen::Vector2d(map.origin_m() + map.resolution_m() * corner.cast<double>());
  };
  for (const Ring& border : occupied_borders(map)) {
    const Ring ring = straightened(border);
    // Two corners are one wall, not there and back.
    const std::size_t num_walls = ring.size() == 2 ? 1 : ring.size();
    for (std::size_t i = 0; i < num_walls; ++i) {
      const Eigen::Vector2i& next = ring[(i + 1) % ring.size()];
      // A ring may pass a corner twice, where cells touch crosswise.
      if (ring[i] != next) world.walls.push_back({point_m(ring[i]), point_m(next)});
    }
  }
  return world;
}

}  // namespace corridor::simulation
