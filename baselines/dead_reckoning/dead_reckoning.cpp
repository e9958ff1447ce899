#include "baselines/dead_reckoning/dead_reckoning.hpp"

#include <optional>
#include <utility>

#include "slam/core/expect.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::dead_reckoning {
namespace {

class DeadReckoning final : public SlamSystem {
 public:
  DeadReckoning(const DeadReckoningParams& params, const RobotModel& robot)
      : params_(params), gyro_(robot.imu, Eigen::Vector3d::Zero()) {}

  std::string_view name() const override {
    return params_.use_gyro ? "dead-reckoning-gyro" : "dead-reckoning";
  }

  Result<StepReport> on_event(const SensorEvent& event) override {
    const auto stage = stage_clock().enter(Stage::kPredict);
    StepReport report;
    report.stamp = stamp_of(event);
    if (const auto* wheels = std::get_if<WheelSample>(&event)) {
      track_.add(*wheels);
      if (!first_T_odom_base_) first_T_odom_base_ = wheels->T_odom_base;
      last_T_odom_base_ = wheels->T_odom_base;
    } else if (const auto* imu = std::get_if<ImuSample>(&event)) {
      add(*imu);
    } else {
      if (params_.use_gyro && !last_imu_) {
        return fail(ErrorCode::kInvalid, "the log has no IMU reading before its first scan",
                    std::string(name()), "a log with a gyro");
      }
      move_to(report.stamp);
      const bool is_later = estimate_.trajectory.append({report.stamp, T_map_base_, std::nullopt});
      CORRIDOR_ENSURE(is_later);
      report.status = StepStatus::kTracked;
      report.T_map_base = T_map_base_;
    }
    return report;
  }

  Result<SlamEstimate> finish() override {
    estimate_.counters["gyro_bias_samples"] = num_bias_samples_;
    return std::move(estimate_);
  }

 private:
  void add(const ImuSample& imu) {
    if (has_moved()) {
      if (!has_fixed_bias_) fix_bias();
    } else {
      rate_sum_ += imu.gyro_z_radps;
      ++num_bias_samples_;
    }
    last_imu_ = imu;
    integrate_until(imu.stamp);
  }

  bool has_moved() const {
    return first_T_odom_base_ &&
           (last_T_odom_base_.translation_m() - first_T_odom_base_->translation_m()).norm() >
               params_.standstill_distance_m;
  }

  void fix_bias() {
    has_fixed_bias_ = true;
    if (num_bias_samples_ < params_.min_standstill_samples) {
      num_bias_samples_ = 0;
      return;
    }
    const double rotated_rad = gyro_.delta().theta_rad;
    const double bias = rate_sum_ / num_bias_samples_;
    // What was integrated so far was the bias of a robot at rest.
    turned_before_rad_ += rotated_rad - bias * gyro_.delta().duration_s;
    gyro_.reset({bias, 0, 0});
  }

  void integrate_until(Timestamp stamp) {
    if (!last_imu_) return;
    const double duration_s = integrated_until_ ? seconds_between(*integrated_until_, stamp) : 0;
    if (duration_s > 0) gyro_.integrate(*last_imu_, duration_s);
    if (!integrated_until_ || duration_s > 0) integrated_until_ = stamp;
  }

  // The translation follows the wheels in the frame of the heading half way through the step.
  void move_to(Timestamp stamp) {
    integrate_until(stamp);
    const std::optional<Pose2> T_odom_base = track_.pose_at(stamp);
    const double turned_rad = turned_before_rad_ + gyro_.delta().theta_rad;
    const bool is_first = estimate_.trajectory.empty();
    if (T_odom_base && scan_T_odom_base_ && !is_first) {
      const Pose2 step = scan_T_odom_base_->between(*T_odom_base);
      const double turn_rad = params_.use_gyro ? turned_rad - scan_turned_rad_ : step.theta_rad();
      // Rotate the wheels' chord by half of what the gyro corrects.
      const Pose2 correction(0, 0, 0.5 * (turn_rad - step.theta_rad()));
      const Eigen::Vector2d chord = correction * step.translation_m();
      T_map_base_ = T_map_base_ * Pose2(chord.x(), chord.y(), turn_rad);
    }
    if (T_odom_base) {
      scan_T_odom_base_ = T_odom_base;
      scan_turned_rad_ = turned_rad;
    }
  }

  const DeadReckoningParams params_;
  motion::WheelTrack track_;
  motion::ImuPreintegrator gyro_;
  std::optional<ImuSample> last_imu_;
  std::optional<Timestamp> integrated_until_;
  double turned_before_rad_ = 0;
  double rate_sum_ = 0;
  int num_bias_samples_ = 0;
  bool has_fixed_bias_ = false;

  std::optional<Pose2> first_T_odom_base_;
  Pose2 last_T_odom_base_;
  std::optional<Pose2> scan_T_odom_base_;  // at the last scan
  double scan_turned_rad_ = 0;
  Pose2 T_map_base_;
  SlamEstimate estimate_;
};

}  // namespace

std::unique_ptr<SlamSystem> make_dead_reckoning(const DeadReckoningParams& params,
                                                const RobotModel& robot) {
  return std::make_unique<DeadReckoning>(params, robot);
}

}  // namespace corridor::dead_reckoning
