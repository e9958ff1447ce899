#include "datasets/formats/maps/ros_map.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr unsigned char kOccupiedPixel = 0;
constexpr unsigned char kFreePixel = 254;
constexpr unsigned char kUnknownPixel = 205;
constexpr double kWhite = 255;
// What a trinary file says is certain to this much: probability 0.953 or 0.047.
constexpr float kCertainLogOdds = 3.0F;
constexpr int kMaxSide_cells = 100'000;
// Longer than anything yaml-cpp says of itself.
constexpr std::size_t kMaxSaid_bytes = 120;
constexpr std::size_t kMaxCells = std::size_t{1} << 28;

unsigned char pixel_of(CellClass cell_class) {
  if (cell_class == CellClass::kUnknown) return kUnknownPixel;
  return cell_class == CellClass::kFree ? kFreePixel : kOccupiedPixel;
}

std::string pgm_of(const GridMap& map) {
  std::string pgm = fmt::format("P5\n{} {}\n255\n", map.num_columns(), map.num_rows());
  for (int row = map.num_rows() - 1; row >= 0; --row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      pgm += static_cast<char>(pixel_of(classify(map.at(column, row))));
    }
  }
  return pgm;
}

std::string yaml_of(const GridMap& map, const std::string& image_name) {
  return fmt::format(
      "image: {}\nresolution: {}\norigin: [{}, {}, 0.0]\nnegate: 0\noccupied_thresh: {}\n"
      "free_thresh: {}\nmode: trinary\n",
      image_name, map.resolution_m(), map.origin_m().x(), map.origin_m().y(), kOccupiedThreshold,
      kFreeThreshold);
}

struct MapHeader {
  std::string image;
  double resolution_m = 0;
  std::array<double, 3> origin{};  // x_m, y_m, yaw_rad
  bool is_negated = false;
  double occupied_threshold = kOccupiedThreshold;
  double free_threshold = kFreeThreshold;
};

std::optional<double> number_of(const YAML::Node& node) {
  if (!node.IsDefined() || !node.IsScalar()) return std::nullopt;
  const auto number = parse_double(node.Scalar());
  return number && std::isfinite(*number) ? number : std::nullopt;
}

// What is wrong with a description, and in which line.
struct Wrong {
  std::string what;
  int line = 0;  // from 0, as yaml-cpp counts; -1: the key is not there
};

// A key that may be missing keeps its value; one that is there must be a number from 0 to 1.
std::optional<Wrong> take_ratio(const YAML::Node& yaml, const char* key, double& value) {
  const YAML::Node node = yaml[key];
  if (!node.IsDefined()) return std::nullopt;
  const auto number = number_of(node);
  if (!number || *number < 0 || *number > 1) {
    return Wrong{fmt::format("{}: not a number from 0 to 1", key), node.Mark().line};
  }
  value = *number;
  return std::nullopt;
}

// Names the first key that is missing or has no sense; nullopt = all is well.
std::optional<Wrong> take_header(const YAML::Node& yaml, MapHeader& header) {
  const auto wrong = [](const YAML::Node& node, const char* what) {
    return Wrong{what, node.IsDefined() ? node.Mark().line : -1};
  };
  if (!yaml.IsMap()) return Wrong{"not a list of keys"};
  const YAML::Node image = yaml["image"];
  if (!image.IsDefined() || !image.IsScalar()) return wrong(image, "image: not a file name");
  header.image = image.Scalar();
  const auto resolution_m = number_of(yaml["resolution"]);
  if (!resolution_m || *resolution_m <= 0) {
    return wrong(yaml["resolution"], "resolution: not a number > 0");
  }
  header.resolution_m = *resolution_m;
  const YAML::Node origin = yaml["origin"];
  if (!origin.IsDefined() || !origin.IsSequence() || origin.size() != header.origin.size()) {
    return wrong(origin, "origin: not [x, y, yaw]");
  }
  for (std::size_t i = 0; i < header.origin.size(); ++i) {
    const auto number = number_of(origin[i]);
    if (!number) return wrong(origin, "origin: not three finite numbers");
    header.origin[i] = *number;
  }
  if (header.origin[2] != 0) return wrong(origin, "origin: a turned map is not supported");
  double negate = 0;
  if (auto bad = take_ratio(yaml, "negate", negate)) return bad;
  if (negate != 0 && negate != 1) return wrong(yaml["negate"], "negate: neither 0 nor 1");
  header.is_negated = negate == 1;
  if (auto bad = take_ratio(yaml, "occupied_thresh", header.occupied_threshold)) return bad;
  if (auto bad = take_ratio(yaml, "free_thresh", header.free_threshold)) return bad;
  if (header.free_threshold > header.occupied_threshold) {
    return wrong(yaml["free_thresh"], "free_thresh: above occupied_thresh");
  }
  const YAML::Node mode = yaml["mode"];
  if (mode.IsDefined() && (!mode.IsScalar() || mode.Scalar() != "trinary")) {
    return wrong(mode, "mode: only trinary is supported");
  }
  return std::nullopt;
}

Result<MapHeader> parse_header(const std::string& text, const std::string& where) {
  try {
    MapHeader header;
    const auto wrong = take_header(YAML::Load(text), header);
    if (!wrong) return header;
    return fail(ErrorCode::kInvalid, wrong->what,
                wrong->line < 0 ? where : fmt::format("{}:{}", where, wrong->line + 1),
                "a description as map_server's, negate: 0 or 1");
  } catch (const YAML::Exception& error) {
    // The library puts bytes of the file into what it says, a line's end among them.
    return fail(ErrorCode::kMalformed, quote(error.msg, kMaxSaid_bytes),
                fmt::format("{}:{}", where, error.mark.line + 1), "YAML");
  }
}

// The next white-space separated token of a PGM header; comments run from '#' to the line's end.
std::string_view take_pgm_token(std::string_view& bytes) {
  constexpr std::string_view kSpace = " \t\r\n";
  for (;;) {
    bytes.remove_prefix(std::min(bytes.find_first_not_of(kSpace), bytes.size()));
    if (bytes.empty() || bytes.front() != '#') break;
    bytes.remove_prefix(std::min(bytes.find('\n'), bytes.size()));
  }
  const std::size_t length = std::min(bytes.find_first_of(kSpace), bytes.size());
  const std::string_view token = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return token;
}

struct Image {
  int num_columns = 0;
  int num_rows = 0;
  std::string_view pixels;  // row by row from the top
};

Result<Image> parse_pgm(std::string_view bytes, const std::string& where) {
  if (take_pgm_token(bytes) != "P5") {
    return fail(ErrorCode::kMalformed, "not a binary PGM image", where, "P5 at byte 0");
  }
  std::array<std::int64_t, 3> header{};
  for (std::int64_t& value : header) {
    const auto number = parse_integer(take_pgm_token(bytes));
    if (!number || *number < 1 || *number > kMaxSide_cells) {
      return fail(ErrorCode::kMalformed, "bad image header", where,
                  "width, height (1 to 100000) and 255");
    }
    value = *number;
  }
  const auto num_pixels = static_cast<std::size_t>(header[0] * header[1]);
  if (header[2] != 255 || num_pixels > kMaxCells) {
    return fail(ErrorCode::kUnsupported, "image too large or not of 8 bits", where,
                fmt::format("255 grey values, at most {} pixels", kMaxCells));
  }
  bytes.remove_prefix(std::min<std::size_t>(1, bytes.size()));  // one white space ends the header
  if (bytes.size() != num_pixels) {
    return fail(ErrorCode::kMalformed, fmt::format("{} bytes of pixels", bytes.size()), where,
                fmt::format("{}", num_pixels));
  }
  return Image{static_cast<int>(header[0]), static_cast<int>(header[1]), bytes};
}

GridCell cell_of_pixel(unsigned char pixel, const MapHeader& header) {
  const double brightness = pixel / kWhite;
  const double probability = header.is_negated ? brightness : 1 - brightness;
  if (probability > header.occupied_threshold) return {kCertainLogOdds, 1, true};
  if (probability < header.free_threshold) return {-kCertainLogOdds, 0, true};
  return {};
}

}  // namespace

CellClass classify(const GridCell& cell) {
  if (!cell.is_observed) return CellClass::kUnknown;
  const double probability = probability_from_log_odds(cell.log_odds);
  if (probability > kOccupiedThreshold) return CellClass::kOccupied;
  return probability < kFreeThreshold ? CellClass::kFree : CellClass::kUnknown;
}

Result<void> write_ros_map(const GridMap& map, const std::filesystem::path& stem) {
  if (map.empty())
    return fail(ErrorCode::kInvalid, "the map has no cells", stem.string(), "at least one");
  const std::filesystem::path image = stem.string() + ".pgm";
  if (auto written = write_file_atomically(image, pgm_of(map)); !written) return written;
  return write_file_atomically(stem.string() + ".yaml", yaml_of(map, image.filename().string()));
}

Result<GridMap> read_ros_map(const std::filesystem::path& yaml_path) {
  const auto yaml = read_file_bytes(yaml_path);
  if (!yaml) return tl::make_unexpected(yaml.error());
  const auto header = parse_header(*yaml, yaml_path.string());
  if (!header) return tl::make_unexpected(header.error());
  // An absolute image name replaces the folder.
  const std::filesystem::path image_path = yaml_path.parent_path() / header->image;
  const auto bytes = read_file_bytes(image_path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const auto image = parse_pgm(*bytes, image_path.string());
  if (!image) return tl::make_unexpected(image.error());
  GridMap map(header->resolution_m, {header->origin[0], header->origin[1]}, image->num_columns,
              image->num_rows);
  std::size_t index = 0;
  for (int row = map.num_rows() - 1; row >= 0; --row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      map.at(column, row) =
          cell_of_pixel(static_cast<unsigned char>(image->pixels[index++]), *header);
    }
  }
  return map;
}

}  // namespace corridor::formats
