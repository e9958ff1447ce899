#include "baselines/dead_reckoning/dead_reckoning.hpp"

#include <optional>
#include <utility>

#include "slam/core/expect.hpp"
#include "slam/motion/imu_track.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::dead_reckoning {
namespace {

class DeadReckoning final : public SlamSystem {
 public:
  DeadReckoning(const DeadReckoningParams& params, const RobotModel& robot)
      : params_(params), gyro_(robot.imu) {}

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
      if (params_.use_gyro && !gyro_.has_reading()) {
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
    gyro_.add(imu);
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
    gyro_.reset({bias, 0, 0, 0});
    scan_unmeasured_s_ = 0;
  }

  // The translation follows the wheels in the frame of the heading half way through the step.
  void move_to(Timestamp stamp) {
    gyro_.advance_to(stamp);
    const std::optional<Pose2> T_odom_base = track_.pose_at(stamp);
    const double turned_rad = turned_before_rad_ + gyro_.delta().theta_rad;
    const bool is_first = estimate_.trajectory.empty();
    if (T_odom_base && scan_T_odom_base_ && !is_first) {
      const Pose2 step = scan_T_odom_base_->between(*T_odom_base);
      // Where readings were missing the wheels have the turn.
      const bool is_gyro_whole = gyro_.delta().unmeasured_s == scan_unmeasured_s_;
      const double turn_rad =
          params_.use_gyro && is_gyro_whole ? turned_rad - scan_turned_rad_ : step.theta_rad();
      // Rotate the wheels' chord by half of what the gyro corrects.
      const Pose2 correction(0, 0, 0.5 * (turn_rad - step.theta_rad()));
      const Eigen::Vector2d chord = correction * step.translation_m();
      T_map_base_ = T_map_base_ * Pose2(chord.x(), chord.y(), turn_rad);
    }
    if (T_odom_base) {
      scan_T_odom_base_ = T_odom_base;
      scan_turned_rad_ = turned_rad;
      scan_unmeasured_s_ = gyro_.delta().unmeasured_s;
    }
  }

  const DeadReckoningParams params_;
  motion::WheelTrack track_;
  motion::ImuTrack gyro_;
  double turned_before_rad_ = 0;
  double rate_sum_ = 0;
  int num_bias_samples_ = 0;
  bool has_fixed_bias_ = false;

  std::optional<Pose2> first_T_odom_base_;
  Pose2 last_T_odom_base_;
  std::optional<Pose2> scan_T_odom_base_;  // at the last scan
  double scan_turned_rad_ = 0, scan_unmeasured_s_ = 0;
  Pose2 T_map_base_;
  SlamEstimate estimate_;
};

}  // namespace

std::unique_ptr<SlamSystem> make_dead_reckoning(const DeadReckoningParams& params,
                                                const RobotModel& robot) {
  return std::make_unique<DeadReckoning>(params, robot);
}

}  // namespace corridor::dead_reckoning
