#include "reports/figures/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/statistics/quantiles.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "reports/figures/raster.hpp"

namespace corridor::figures {
namespace {

namespace fs = std::filesystem;

constexpr double kMinStep_px = 0.5;
constexpr std::uint32_t kOccupied = 0xFF000000;
constexpr std::uint32_t kFree = 0xFFFFFFFF;
constexpr std::uint32_t kTransparent = 0;

template <class Read>
auto read_if_there(const fs::path& path, Read&& read, std::vector<std::string>& problems)
    -> std::optional<typename decltype(read(path))::value_type> {
  if (!fs::exists(path)) return std::nullopt;
  auto value = read(path);
  if (value) return std::move(*value);
  problems.push_back(value.error().to_line());
  return std::nullopt;
}

Pose2 aligned_at_first_pose(const Trajectory& truth, const Trajectory& estimate) {
  for (const TrajectoryPose& pose : estimate.poses()) {
    if (const auto T_world_base = truth.interpolate(pose.stamp)) {
      return *T_world_base * pose.T_map_base.inverse();
    }
  }
  return {};
}

// Columns and rows of the observed part: [first, last].
struct CellRange {
  int first_column = 0, last_column = -1, first_row = 0, last_row = -1;

  [[nodiscard]] bool is_empty() const { return last_column < first_column; }
  [[nodiscard]] int width() const { return last_column - first_column + 1; }
  [[nodiscard]] int height() const { return last_row - first_row + 1; }
};

CellRange observed_range(const GridMap& map) {
  CellRange range{map.num_columns(), -1, map.num_rows(), -1};
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      if (formats::classify(map.at(column, row)) == formats::CellClass::kUnknown) continue;
      range.first_column = std::min(range.first_column, column);
      range.last_column = std::max(range.last_column, column);
      range.first_row = std::min(range.first_row, row);
      range.last_row = std::max(range.last_row, row);
    }
  }
  return range;
}

// What a block of `factor` x `factor` cells shows: occupied before free before unknown.
std::uint32_t block_pixel(const GridMap& map, int first_column, int first_row, int factor) {
  std::uint32_t pixel = kTransparent;
  for (int row = first_row; row < first_row + factor; ++row) {
    for (int column = first_column; column < first_column + factor; ++column) {
      if (!map.contains(column, row)) continue;
      const formats::CellClass kind = formats::classify(map.at(column, row));
      if (kind == formats::CellClass::kOccupied) return kOccupied;
      if (kind == formats::CellClass::kFree) pixel = kFree;
    }
  }
  return pixel;
}

// Rows from the top, as images have them; the range grows upwards and to the right to whole blocks.
PixelImage pixels_of(const GridMap& map, const CellRange& range, int factor) {
  PixelImage image{
      (range.width() + factor - 1) / factor, (range.height() + factor - 1) / factor, {}};
  for (int block_row = image.height - 1; block_row >= 0; --block_row) {
    for (int block_column = 0; block_column < image.width; ++block_column) {
      image.pixels.push_back(block_pixel(map, range.first_column + block_column * factor,
                                         range.first_row + block_row * factor, factor));
    }
  }
  return image;
}

Eigen::Vector2d corner_m(const GridMap& map, int column, int row) {
  return map.origin_m() + map.resolution_m() * Eigen::Vector2d(column, row);
}

}  // namespace

Scene load_scene(const reports::Case& entry, std::vector<std::string>& problems) {
  Scene scene;
  scene.truth = read_if_there(entry.dir / "truth.tum", formats::read_tum, problems);
  scene.estimate = read_if_there(entry.dir / "final.tum", formats::read_tum, problems);
  scene.map = read_if_there(entry.dir / "map.yaml", formats::read_ros_map, problems);
  if (!scene.map) {
    scene.map = read_if_there(entry.dir / "rendered.yaml", formats::read_ros_map, problems);
    scene.is_map_rendered = scene.map.has_value();
  }
  scene.world = read_if_there(entry.dir / "world.toml", simulation::read_world, problems);
  if (scene.truth && scene.estimate) {
    scene.T_world_map = aligned_at_first_pose(*scene.truth, *scene.estimate);
  }
  return scene;
}

std::vector<Eigen::Vector2d> positions_m(const Trajectory& trajectory, const Pose2& T) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(trajectory.size());
  for (const TrajectoryPose& pose : trajectory.poses()) {
    points.push_back(T * pose.T_map_base.translation_m());
  }
  return points;
}

void draw_path(Svg& svg, const PlaneFrame& frame, const std::vector<Eigen::Vector2d>& points_m,
               std::string_view classes) {
  std::vector<Eigen::Vector2d> points_px;
  for (const Eigen::Vector2d& point_m : points_m) {
    const Eigen::Vector2d point_px = frame(point_m);
    if (points_px.empty() || (point_px - points_px.back()).norm() >= kMinStep_px) {
      points_px.push_back(point_px);
    }
  }
  svg.polyline(points_px, classes);
}

void include(const simulation::World& world, Bounds& bounds) {
  for (const auto& line : simulation::outlines_m(world)) {
    for (const Eigen::Vector2d& point_m : line) bounds.include(point_m);
  }
}

void draw_walls(Svg& svg, const PlaneFrame& frame, const simulation::World& world,
                std::string_view classes) {
  for (const std::vector<Eigen::Vector2d>& line : simulation::outlines_m(world)) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d a_px = frame(line[i]);
      const Eigen::Vector2d b_px = frame(line[i + 1]);
      svg.line(a_px.x(), a_px.y(), b_px.x(), b_px.y(), classes);
    }
  }
}

void draw_scale_bar(Svg& svg, const PlaneFrame& frame, double x_px, double y_px, double width_px) {
  const std::vector<Tick> ticks = linear_ticks(0, width_px / frame.px_per_m(), 5);
  if (ticks.size() < 2) return;
  const double length_px = ticks[1].value * frame.px_per_m();
  svg.line(x_px, y_px, x_px + length_px, y_px, "interval");
  svg.text(x_px + length_px + 6, y_px + 4, ticks[1].label + " m", "small halo");
  svg.text(x_px + length_px + 6, y_px + 4, ticks[1].label + " m", "small");
}

bool draw_map(Svg& svg, const PlaneFrame& frame, const GridMap& map, const Pose2& T_world_map) {
  const CellRange range = observed_range(map);
  if (range.is_empty()) return false;
  const double cells_per_px = 1 / (frame.px_per_m() * map.resolution_m());
  const int factor = std::max(1, static_cast<int>(std::lround(cells_per_px)));
  const PixelImage image = pixels_of(map, range, factor);
  const auto png = png_from_pixels(image);
  if (!png) return false;
  const int end_column = range.first_column + image.width * factor;
  const int end_row = range.first_row + image.height * factor;
  // The unit square of the image: (0, 0) is the upper left corner, (1, 1) the lower right one.
  const auto corner_px = [&](int column, int row) {
    return frame(T_world_map * corner_m(map, column, row));
  };
  const Eigen::Vector2d origin = corner_px(range.first_column, end_row);
  const Eigen::Vector2d right = corner_px(end_column, end_row) - origin;
  const Eigen::Vector2d down = corner_px(range.first_column, range.first_row) - origin;
  svg.image(*png, fmt::format("matrix({:.6f} {:.6f} {:.6f} {:.6f} {:.4f} {:.4f})", right.x(),
                              right.y(), down.x(), down.y(), origin.x(), origin.y()));
  return true;
}

Bounds occupied_bounds(const GridMap& map, const Pose2& T_world_map) {
  std::vector<double> x_m;
  std::vector<double> y_m;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      if (formats::classify(map.at(column, row)) != formats::CellClass::kOccupied) continue;
      const Eigen::Vector2d centre_m = T_world_map * map.centre_m(column, row);
      x_m.push_back(centre_m.x());
      y_m.push_back(centre_m.y());
    }
  }
  Bounds bounds;
  if (x_m.empty()) return bounds;
  for (const double percent : {1.0, 99.0}) {
    bounds.include({*statistics::percentile(x_m, percent), *statistics::percentile(y_m, percent)});
  }
  return bounds;
}

}  // namespace corridor::figures
