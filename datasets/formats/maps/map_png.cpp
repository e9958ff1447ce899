#include "datasets/formats/maps/map_png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <string>
#include <vector>

#include "datasets/formats/atomic_file.hpp"

namespace corridor::formats {
namespace {

constexpr png_byte kUnknownGrey = 205;
constexpr double kWhite = 255;

png_byte grey_of(const GridCell& cell) {
  if (!cell.is_observed) return kUnknownGrey;
  return static_cast<png_byte>(
      std::lround(kWhite * (1 - probability_from_log_odds(cell.log_odds))));
}

std::vector<png_byte> pixels_of(const GridMap& map) {
  std::vector<png_byte> pixels;
  pixels.reserve(static_cast<std::size_t>(map.num_columns()) *
                 static_cast<std::size_t>(map.num_rows()));
  for (int row = map.num_rows() - 1; row >= 0; --row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      pixels.push_back(grey_of(map.at(column, row)));
    }
  }
  return pixels;
}

}  // namespace

Result<void> write_map_png(const GridMap& map, const std::filesystem::path& path) {
  if (map.empty())
    return fail(ErrorCode::kInvalid, "the map has no cells", path.string(), "at least one");
  const std::vector<png_byte> pixels = pixels_of(map);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(map.num_columns());
  image.height = static_cast<png_uint_32>(map.num_rows());
  image.format = PNG_FORMAT_GRAY;
  png_alloc_size_t num_bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(num_bytes, '\0');
  if (png_image_write_to_memory(&image, png.data(), &num_bytes, 0, pixels.data(), 0, nullptr) ==
      0) {
    return fail(ErrorCode::kInternal, fmt::format("libpng: {}", image.message), path.string());
  }
  png.resize(num_bytes);
  return write_file_atomically(path, png);
}

}  // namespace corridor::formats
