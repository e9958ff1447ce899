#include "baselines/karto/key_scan.hpp"

#include <cmath>
#include <limits>

namespace corridor::karto {
namespace {

// Ranges are kept in single precision; whole tenths of a millimetre, finer than any LiDAR states,
// give back the decimal that the sensor said. Matching has near ties that 1e-7 m decides.
constexpr double kRangeQuanta_per_m = 1e4;
// A longer raw range is no end point at all.
constexpr double kMaxRawRange_m = 1e4;

double undo_single_precision(float range_m) {
  return std::round(static_cast<double>(range_m) * kRangeQuanta_per_m) / kRangeQuanta_per_m;
}

}  // namespace

KeyScan::KeyScan(const LaserScan& scan, const Pose2& T_odom_base, const KeyScanOptions& options)
    : stamp_(scan.stamp),
      T_base_sensor_(scan.T_base_lidar),
      T_odom_sensor_(T_odom_base * scan.T_base_lidar),
      options_(options) {
  const std::size_t num_beams = scan.num_beams();
  beams_sensor_m_.resize(num_beams);
  is_in_range_.resize(num_beams);
  is_return_.resize(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) {
    const double range_m = undo_single_precision(scan.ranges_m[i]);
    const double angle_rad = scan.angle_rad(i);
    const bool is_finite = std::abs(range_m) <= kMaxRawRange_m;  // false for NaN
    is_return_[i] = is_finite && scan.is_valid[i] != 0;
    is_in_range_[i] = is_return_[i] && range_m <= options.range_threshold_m;
    if (is_in_range_[i]) ++num_in_range_;
    beams_sensor_m_[i] =
        is_finite ? Eigen::Vector2d(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad))
                  : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    if (has_point(i)) ++num_points_;
  }
  set_T_map_sensor(T_odom_sensor_);
}

void KeyScan::set_T_map_sensor(const Pose2& T_map_sensor) {
  T_map_sensor_ = T_map_sensor;
  const Eigen::Matrix2d R_map_sensor = T_map_sensor.rotation();
  const Eigen::Vector2d t_map_sensor_m = T_map_sensor.translation_m();
  points_map_m_.resize(num_points_, 2);
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < beams_sensor_m_.size(); ++i) {
    if (!has_point(i)) continue;
    const Eigen::Vector2d point_map_m = R_map_sensor * beams_sensor_m_[i] + t_map_sensor_m;
    points_map_m_.row(row++) = point_map_m.transpose();
    if (is_in_range_[i]) sum_m += point_map_m;
  }
  surface_map_.cut(points_map_m_, kAnchorSpacing_m);
  reference_map_m_ = options_.use_barycentre && is_usable()
                         ? Eigen::Vector2d(sum_m / static_cast<double>(num_in_range_))
                         : t_map_sensor_m;
}

}  // namespace corridor::karto
