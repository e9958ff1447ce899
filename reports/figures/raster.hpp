// The door to librsvg and cairo: SVG text to PNG bytes, pixels to PNG bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::figures {

// `scale` pixels of the image per pixel of the figure. Follows no link and reads no other file.
Result<std::string> png_from_svg(const std::string& svg, double scale);

// One pixel: 0xAARRGGBB, not premultiplied; rows from the top.
struct PixelImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;
};
Result<std::string> png_from_pixels(const PixelImage& image);

}  // namespace corridor::figures
