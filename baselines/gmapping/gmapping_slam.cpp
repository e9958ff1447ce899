#include "baselines/gmapping/gmapping_slam.hpp"

#include <cmath>

#include "baselines/gmapping/particle_filter.hpp"
#include "baselines/gmapping/published_map.hpp"
#include "baselines/gmapping/scan_points.hpp"
#include "slam/motion/dense_path.hpp"
#include "slam/motion/gyro_odometry.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::gmapping {
namespace {

// Opens when the odometry has moved far enough since the last used scan; the first scan is used
// too.
class UpdateGate {
 public:
  explicit UpdateGate(const GmappingParams& params) : params_(params) {}

  void add(const Pose2& T_before_after) {
    path_m_ += T_before_after.translation_m().norm();
    rotation_rad_ += std::abs(T_before_after.theta_rad());
  }
  [[nodiscard]] bool is_open() const {
    return is_first_ || path_m_ >= params_.linear_update_m ||
           rotation_rad_ >= params_.angular_update_rad;
  }
  void close() {
    is_first_ = false;
    path_m_ = 0;
    rotation_rad_ = 0;
  }

 private:
  GmappingParams params_;
  bool is_first_ = true;
  double path_m_ = 0;
  double rotation_rad_ = 0;
};

class GmappingSlam final : public SlamSystem {
 public:
  GmappingSlam(const GmappingParams& params, const RobotModel& robot, Rng rng, int num_threads)
      : params_(params),
        robot_(robot),
        gyro_odometry_(robot),
        gate_(params),
        filter_(params, rng, num_threads) {}

  [[nodiscard]] std::string_view name() const override { return "gmapping"; }

  Result<StepReport> on_event(const SensorEvent& event) override {
    if (const auto* wheel = std::get_if<WheelSample>(&event)) {
      wheel_track_.add(params_.use_gyro_odometry ? gyro_odometry_.corrected(*wheel) : *wheel);
    }
    const auto* imu = std::get_if<ImuSample>(&event);
    if (imu != nullptr && params_.use_gyro_odometry) gyro_odometry_.add(*imu);
    const auto* scan = std::get_if<LaserScan>(&event);
    StepReport report;
    report.stamp = stamp_of(event);
    if (scan == nullptr) return report;
    report.is_key_scan = on_scan(*scan);
    report.status = StepStatus::kTracked;
    if (report.is_key_scan) T_map_start_ = filter_.best().T_map_base * T_start_base_.inverse();
    report.T_map_base = T_map_start_ * T_start_base_;
    return report;
  }

  Result<SlamEstimate> finish() override {
    const auto scope = stage_clock().enter(Stage::kFinish);
    SlamEstimate estimate;
    const std::vector<Pose2> path_map_base = filter_.best_path();
    estimate.trajectory = motion::dense_path(records_, path_map_base);
    estimate.map = published_map(used_scans_, path_map_base, params_);
    estimate.counters = {{"key_scans", static_cast<double>(used_scans_.size())},
                         {"resamplings", num_resamplings_},
                         {"score_evaluations", filter_.num_score_evaluations()}};
    return estimate;
  }

 private:
  // One scan as in [Grisetti2007] section V, algorithm 1. True if the scan was used.
  bool on_scan(const LaserScan& scan) {
    predict(scan.stamp);
    const bool is_used = gate_.is_open();
    records_.push_back({scan.stamp, T_start_base_, is_used});
    if (!is_used) return false;
    const bool is_first = used_scans_.empty();
    keep_points(scan);
    if (!is_first) {
      match(scan);
      resample();
    }
    update_maps();
    gate_.close();
    return true;
  }

  // Every scan moves the particles, used or not. Without wheel odometry the robot stands still.
  void predict(Timestamp stamp) {
    const auto scope = stage_clock().enter(Stage::kPredict);
    const std::optional<Pose2> T_odom_base = wheel_track_.pose_at(stamp);
    if (!T_odom_base) return;
    if (last_T_odom_base_) {
      const Pose2 T_before_after = last_T_odom_base_->between(*T_odom_base);
      filter_.predict(T_before_after);
      gate_.add(T_before_after);
      T_start_base_ = T_start_base_ * T_before_after;
    }
    last_T_odom_base_ = T_odom_base;
  }

  void keep_points(const LaserScan& scan) {
    const auto scope = stage_clock().enter(Stage::kPreprocess);
    used_scans_.push_back({usable_points(scan, selection(scan, 1)), scan.T_base_lidar});
  }

  void match(const LaserScan& scan) {
    const auto scope = stage_clock().enter(Stage::kMatch);
    if (params_.num_skipped_beams == 0) {
      filter_.match_and_weigh(used_scans_.back().points);
    } else {
      const int stride = params_.num_skipped_beams + 1;
      filter_.match_and_weigh(usable_points(scan, selection(scan, stride)));
    }
  }

  void resample() {
    const auto scope = stage_clock().enter(Stage::kResample);
    if (filter_.resample_if_needed()) ++num_resamplings_;
  }

  void update_maps() {
    const auto scope = stage_clock().enter(Stage::kMapUpdate);
    filter_.register_scan(used_scans_.back().points);
  }

  [[nodiscard]] BeamSelection selection(const LaserScan& scan, int stride) const {
    const double sensor_m = scan.range_max_m > 0 ? scan.range_max_m : robot_.lidar.range_max_m;
    return {.max_range_m = sensor_m - params_.range_margin_m,
            .tilt_steps = params_.beam_tilt_steps,
            .stride = stride};
  }

  GmappingParams params_;
  RobotModel robot_;
  motion::GyroOdometry gyro_odometry_;
  UpdateGate gate_;
  ParticleFilter filter_;
  motion::WheelTrack wheel_track_;
  std::optional<Pose2> last_T_odom_base_;    // at the last scan
  Pose2 T_start_base_;                       // odometry since the first scan
  Pose2 T_map_start_;                        // correction of the odometry at the last used scan
  std::vector<motion::ScanRecord> records_;  // one per scan
  std::vector<UsedScan> used_scans_;
  double num_resamplings_ = 0;
};

}  // namespace

std::unique_ptr<SlamSystem> make_gmapping(const GmappingParams& params, const RobotModel& robot,
                                          Rng rng, int num_threads) {
  return std::make_unique<GmappingSlam>(params, robot, rng, num_threads);
}

}  // namespace corridor::gmapping
