// Closed lines around the occupied cells of a map, and the straight walls that their staircases
// stand for. Coordinates are corners of cells: (column, row).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/core/grid_map.hpp"

namespace corridor::simulation {

// A closed line through its corners; from the last it goes back to the first.
using Ring = std::vector<Eigen::Vector2i>;

// Every border between an occupied cell and another, or the map's edge, is part of one ring, with
// the occupied cells to its left. Cells that touch at a corner are joined, so that no ray passes
// between them.
std::vector<Ring> occupied_borders(const GridMap& map);

// The most that straightened() moves a border. Just more than a cell's diagonal: the corners of the
// cells along a straight wall of any direction lie in a strip that is narrower than that.
inline constexpr double kStraightWithin_cells = 1.42;

// The ring through as few of its corners as keep every other one within kStraightWithin_cells
// [Douglas1973]. The new ring is as near to the old one: places farther from it than that stay on
// the side on which they are; lines that were nearer to one another may touch or cross there. Kept
// are besides: corners between two straight runs, which no slanted wall has, the ends of thin
// walls, and rings of few cells, which are given back as they are.
Ring straightened(const Ring& ring);

}  // namespace corridor::simulation
