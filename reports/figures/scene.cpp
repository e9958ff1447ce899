#include "reports/figures/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "datasets/formats/ros_map.hpp"
#include "datasets/formats/tum.hpp"
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

PixelImage pixels_of(const GridMap& map, const CellRange& range) {
  PixelImage image{range.width(), range.height(), {}};
  for (int row = range.last_row; row >= range.first_row; --row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      const formats::CellClass kind = formats::classify(map.at(column, row));
      image.pixels.push_back(kind == formats::CellClass::kUnknown    ? kTransparent
                             : kind == formats::CellClass::kOccupied ? kOccupied
                                                                     : kFree);
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

void draw_walls(Svg& svg, const PlaneFrame& frame, const simulation::World& world,
                std::string_view classes) {
  for (const simulation::Segment& wall : world.walls) {
    const Eigen::Vector2d a_px = frame(wall.a_m);
    const Eigen::Vector2d b_px = frame(wall.b_m);
    svg.line(a_px.x(), a_px.y(), b_px.x(), b_px.y(), classes);
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
  const auto png = png_from_pixels(pixels_of(map, range));
  if (!png) return false;
  // The unit square of the image: (0, 0) is the upper left corner, (1, 1) the lower right one.
  const Eigen::Vector2d origin =
      frame(T_world_map * corner_m(map, range.first_column, range.last_row + 1));
  const Eigen::Vector2d right =
      frame(T_world_map * corner_m(map, range.last_column + 1, range.last_row + 1)) - origin;
  const Eigen::Vector2d down =
      frame(T_world_map * corner_m(map, range.first_column, range.first_row)) - origin;
  svg.image(*png, fmt::format("matrix({:.6f} {:.6f} {:.6f} {:.6f} {:.4f} {:.4f})", right.x(),
                              right.y(), down.x(), down.y(), origin.x(), origin.y()));
  return true;
}

std::vector<Eigen::Vector2d> map_corners_m(const GridMap& map, const Pose2& T_world_map) {
  const CellRange range = observed_range(map);
  if (range.is_empty()) return {};
  std::vector<Eigen::Vector2d> corners;
  for (const int column : {range.first_column, range.last_column + 1}) {
    for (const int row : {range.first_row, range.last_row + 1}) {
      corners.push_back(T_world_map * corner_m(map, column, row));
    }
  }
  return corners;
}

}  // namespace corridor::figures
