#include "bench/metrics/map_cloud.hpp"

#include <open3d/geometry/PointCloud.h>
#include <open3d/io/PointCloudIO.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <numeric>

#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"
#include "bench/metrics/wall_visibility.hpp"
#include "bench/statistics/quantiles.hpp"

namespace corridor::metrics {
namespace {

constexpr double kWallPointSpacing_m = 0.05;
constexpr double kOccupiedProbability = 0.5;
constexpr double kHausdorffPercent = 95;

open3d::geometry::PointCloud to_open3d(const PlanarCloud& cloud) {
  open3d::geometry::PointCloud result;
  result.points_.reserve(cloud.size());
  for (const Eigen::Vector2d& point_m : cloud) {
    result.points_.emplace_back(point_m.x(), point_m.y(), 0.0);
  }
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

PlanarCloud visible_wall_points(const simulation::World& world,
                                const std::vector<MatchedPose>& pairs, double lidar_range_m) {
  std::vector<Pose2> T_world_base;
  for (const MatchedPose& pair : pairs) T_world_base.push_back(pair.T_world_base);
  const auto samples = sample_walls(world, kWallPointSpacing_m);
  const auto sightings = find_sightings(samples, world, T_world_base, lidar_range_m);
  PlanarCloud points;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!sightings[k].empty()) points.push_back(samples[k].point_world_m);
  }
  return points;
}

}  // namespace

PlanarCloud occupied_points_world(const GridMap& map, const Pose2& T_world_map) {
  PlanarCloud points;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      const double probability = probability_from_log_odds(map.at(column, row).log_odds);
      if (probability > kOccupiedProbability) {
        points.push_back(T_world_map * map.centre_m(column, row));
      }
    }
  }
  return points;
}

std::optional<CloudDistances> cloud_distances(const PlanarCloud& a, const PlanarCloud& b) {
  if (a.empty() || b.empty()) return std::nullopt;
  auto cloud_a = to_open3d(a);  // not const: Open3D 0.16 declares the distance so
  auto cloud_b = to_open3d(b);
  const auto from_a_m = cloud_a.ComputePointCloudDistance(cloud_b);
  const auto from_b_m = cloud_b.ComputePointCloudDistance(cloud_a);
  const auto far_a_m = statistics::percentile(from_a_m, kHausdorffPercent);
  const auto far_b_m = statistics::percentile(from_b_m, kHausdorffPercent);
  if (!far_a_m || !far_b_m) return std::nullopt;
  return CloudDistances{(mean(from_a_m) + mean(from_b_m)) / 2, std::max(*far_a_m, *far_b_m)};
}

std::optional<CloudDistances> score_map_cloud(const GridMap& map, const Trajectory& estimate,
                                              const Trajectory& truth_world,
                                              const simulation::World& world,
                                              double lidar_range_m) {
  const auto pairs = associate(estimate, truth_world, AssociationRule::kNearest).pairs;
  const auto T_world_map = align(pairs, Alignment::kOrigin);
  if (!T_world_map) return std::nullopt;
  return cloud_distances(occupied_points_world(map, *T_world_map),
                         visible_wall_points(world, pairs, lidar_range_m));
}

Result<void> write_ply(const PlanarCloud& cloud, const std::filesystem::path& path) {
  if (cloud.empty()) {
    return fail(ErrorCode::kInvalid, "the cloud is empty", path.string(), "at least one point");
  }
  // Open3D and its PLY library print to the terminal when a file cannot be opened: ask first.
  if (!std::ofstream(path, std::ios::binary)) {
    return fail(ErrorCode::kUnreadable, "cannot be opened for writing", path.string(),
                "a file in a folder that exists");
  }
  try {
    if (open3d::io::WritePointCloudToPLY(path.string(), to_open3d(cloud), {})) return {};
  } catch (const std::exception& error) {
    return fail(ErrorCode::kInternal, error.what(), path.string());
  }
  return fail(ErrorCode::kUnreadable, "could not be written in full", path.string(),
              "enough space on the disk");
}

}  // namespace corridor::metrics
