#include "baselines/mrpt/conversions.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/slam/CICP.h>

#include <chrono>
#include <cmath>

namespace corridor::mrpt {
namespace {

// MRPT counts 100 ns since 1601.
constexpr std::int64_t kNanosecondsPerTick = 100;
constexpr std::int64_t kTicksFrom1601To1970 = 116444736000000000;

::mrpt::Clock::time_point to_mrpt(Timestamp stamp) {
  return ::mrpt::Clock::time_point(
      ::mrpt::Clock::duration(kTicksFrom1601To1970 + stamp.nanoseconds / kNanosecondsPerTick));
}

}  // namespace

std::shared_ptr<::mrpt::obs::CObservation2DRangeScan> to_mrpt(const LaserScan& scan,
                                                              double range_sigma_m) {
  auto out = std::make_shared<::mrpt::obs::CObservation2DRangeScan>();
  const double span_rad =
      scan.num_beams() < 2 ? 0.0
                           : scan.angle_increment_rad * static_cast<double>(scan.num_beams() - 1);
  const Pose2 T_base_fan = scan.T_base_lidar * Pose2(0, 0, scan.angle_min_rad + span_rad / 2);
  out->timestamp = to_mrpt(scan.stamp);
  out->sensorLabel = "LIDAR";
  out->aperture = static_cast<float>(std::abs(span_rad));
  out->rightToLeft = scan.angle_increment_rad >= 0;
  out->maxRange = static_cast<float>(scan.range_max_m);
  out->stdError = static_cast<float>(range_sigma_m);
  out->sensorPose = ::mrpt::poses::CPose3D(
      ::mrpt::poses::CPose2D(T_base_fan.x_m(), T_base_fan.y_m(), T_base_fan.theta_rad()));
  out->resizeScan(scan.num_beams());
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    out->setScanRange(i, scan.ranges_m[i]);
    out->setScanRangeValidity(i, scan.is_valid[i] != 0);
  }
  return out;
}

std::shared_ptr<::mrpt::obs::CObservationOdometry> to_mrpt(Timestamp stamp,
                                                           const Pose2& T_odom_base) {
  auto out = std::make_shared<::mrpt::obs::CObservationOdometry>();
  out->timestamp = to_mrpt(stamp);
  out->sensorLabel = "WHEELS";
  out->odometry = to_mrpt(T_odom_base);
  return out;
}

::mrpt::poses::CPose2D to_mrpt(const Pose2& pose) {
  return {pose.x_m(), pose.y_m(), pose.theta_rad()};
}

::mrpt::slam::CICP to_mrpt(const IcpParams& params) {
  ::mrpt::slam::CICP::TConfigParams icp;
  icp.ICP_algorithm = params.use_levenberg_marquardt ? ::mrpt::slam::icpLevenbergMarquardt
                                                     : ::mrpt::slam::icpClassic;
  icp.maxIterations = static_cast<unsigned>(params.max_iterations);
  icp.minAbsStep_trans = params.min_step_m;
  icp.minAbsStep_rot = params.min_step_rad;
  icp.thresholdDist = params.threshold_m;
  icp.thresholdAng = params.threshold_rad;
  icp.ALFA = params.threshold_shrink_ratio;
  icp.smallestThresholdDist = params.smallest_threshold_m;
  icp.onlyUniqueRobust = params.use_unique_robust;
  icp.corresponding_points_decimation = static_cast<unsigned>(params.point_decimation);
  return ::mrpt::slam::CICP(icp);
}

Pose2 to_pose2(const ::mrpt::poses::CPose3D& pose) { return {pose.x(), pose.y(), pose.yaw()}; }

GridMap to_grid_map(const ::mrpt::maps::COccupancyGridMap2D& grid) {
  const auto num_columns = static_cast<int>(grid.getSizeX());
  const auto num_rows = static_cast<int>(grid.getSizeY());
  GridMap map(grid.getResolution(), {grid.getXMin(), grid.getYMin()}, num_columns, num_rows);
  for (int row = 0; row < num_rows; ++row) {
    const auto* cells = grid.getRow(row);
    for (int column = 0; column < num_columns; ++column) {
      if (cells[column] == 0) continue;
      const double probability_free = grid.getCell(column, row);
      GridCell& cell = map.at(column, row);
      cell.is_observed = true;
      cell.log_odds = static_cast<float>(-log_odds_from_probability(probability_free));
    }
  }
  return map;
}

GridMap to_grid_map(const ::mrpt::maps::CSimpleMap& key_scans, double cell_size_m) {
  if (key_scans.empty()) return {};
  ::mrpt::maps::COccupancyGridMap2D grid(-1, 1, -1, 1, static_cast<float>(cell_size_m));
  grid.loadFromSimpleMap(key_scans);
  return to_grid_map(grid);
}

}  // namespace corridor::mrpt
