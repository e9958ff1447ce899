// Occupancy map to walls.
#include <algorithm>

#include "datasets/simulation/world.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

bool is_occupied(const GridMap& map, int column, int row) {
  return map.contains(column, row) && map.at(column, row).is_observed &&
         map.at(column, row).log_odds > 0;
}

// Borders along one axis. `is_border(line, k)`: the edge from k to k + 1 on a grid line lies
// between an occupied cell and another; consecutive ones become one wall, `corner(line, k)` its
// ends.
template <class IsBorder, class Corner>
void trace(int num_lines, int num_edges, const IsBorder& is_border, const Corner& corner,
           std::vector<Segment>& walls) {
  for (int line = 0; line <= num_lines; ++line) {
    for (int begin = 0; begin < num_edges;) {
      int end = begin;
      while (end < num_edges && is_border(line, end)) ++end;
      if (end > begin) walls.push_back({corner(line, begin), corner(line, end)});
      begin = end + 1;
    }
  }
}

}  // namespace

World traced_world(const GridMap& map) {
  World world;
  const auto point_m = [&](int column, int row) {
    return Vector2d(map.origin_m() + map.resolution_m() * Vector2d(column, row));
  };
  trace(
      map.num_rows(), map.num_columns(),
      [&](int row, int column) {
        return is_occupied(map, column, row - 1) != is_occupied(map, column, row);
      },
      [&](int row, int column) { return point_m(column, row); }, world.walls);
  trace(
      map.num_columns(), map.num_rows(),
      [&](int column, int row) {
        return is_occupied(map, column - 1, row) != is_occupied(map, column, row);
      },
      [&](int column, int row) { return point_m(column, row); }, world.walls);
  return world;
}

}  // namespace corridor::simulation
