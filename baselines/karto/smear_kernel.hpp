// The stamp with which an end point is drawn into a correlation grid: a Gaussian in whole percent.
#pragma once

#include <cstdint>
#include <vector>

namespace corridor::karto {

// Value of a cell that holds an end point; look-ups divide by it.
inline constexpr std::uint8_t kOccupied = 100;

// Square of side 2 * half_width + 1 around the end point; value round(100 * exp(-0.5 (d /
// sigma)^2)) with half width round(2 * sigma / resolution). Rows lie `stride` bytes apart; the
// bytes beyond the side are zero, so that whole blocks of kBlock bytes can be merged with max().
struct SmearKernel {
  static constexpr int kBlock = 16;

  SmearKernel(double sigma_m, double resolution_m);

  int half_width = 0;
  int side = 1;
  int stride = kBlock;
  std::vector<std::uint8_t> values;

  [[nodiscard]] std::uint8_t at(int dx, int dy) const {
    return values[static_cast<std::size_t>((dy + half_width) * stride + dx + half_width)];
  }
};

}  // namespace corridor::karto
