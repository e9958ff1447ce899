// Stamps of readings that were taken at a constant rate but stamped by a program that came to them
// early or late. Internal to this folder.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/core/timestamp.hpp"

namespace corridor::formats {

struct EvenStamps {
  std::vector<Timestamp> stamps;  // as many as were given
  double period_s = 0;
  double largest_move_s = 0;   // of a stamp, either way
  std::size_t most_moved = 0;  // its index
};

// The straight line through the stamps over their index, by least squares: no reading may be
// missing. Requires two stamps or more.
EvenStamps even_stamps(const std::vector<Timestamp>& stamps);

}  // namespace corridor::formats
