#include "datasets/formats/truth_health.hpp"

#include <algorithm>
#include <optional>

namespace corridor::formats {
namespace {

constexpr std::int64_t kNearTruth_ns = 10'000'000;
// Noise of a true pose, of centimetres, is little of what robots drive in this time.
constexpr double kCommonStep_s = 1;

double scans_with_pose_ratio(const SensorLog& log) {
  const auto& poses = log.truth->poses();
  std::size_t num_scans = 0;
  std::size_t num_near = 0;
  for (const SensorEvent& event : log.events) {
    if (!std::holds_alternative<LaserScan>(event)) continue;
    ++num_scans;
    const std::int64_t stamp_ns = stamp_of(event).nanoseconds;
    const auto next = std::lower_bound(
        poses.begin(), poses.end(), Timestamp{stamp_ns - kNearTruth_ns},
        [](const TrajectoryPose& pose, Timestamp stamp) { return pose.stamp < stamp; });
    const bool is_near = next != poses.end() && next->stamp.nanoseconds <= stamp_ns + kNearTruth_ns;
    num_near += is_near ? 1 : 0;
  }
  return num_scans == 0 ? 0 : static_cast<double>(num_near) / static_cast<double>(num_scans);
}

void count_fast_steps(const Trajectory& truth, const LogLimits& limits, TruthHealth& health) {
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const double step_s = seconds_between(truth[i - 1].stamp, truth[i].stamp);
    const double length_m =
        (truth[i].T_map_base.translation_m() - truth[i - 1].T_map_base.translation_m()).norm();
    if (length_m <= limits.max_speed_mps * step_s + limits.max_jump_m) continue;
    if (health.num_fast_steps++ == 0) health.first_fast_step_s = to_seconds(truth[i].stamp);
  }
}

std::vector<WheelSample> finite_wheels_of(const SensorLog& log) {
  std::vector<WheelSample> wheels;
  for (const SensorEvent& event : log.events) {
    const auto* sample = std::get_if<WheelSample>(&event);
    if (sample != nullptr && sample->T_odom_base.is_finite()) wheels.push_back(*sample);
  }
  return wheels;
}

// Where both have been at one time.
struct Common {
  Timestamp stamp;
  Eigen::Vector2d true_m, wheels_m;
};

void compare_with_wheels(const SensorLog& log, TruthHealth& health) {
  const std::vector<WheelSample> wheels = finite_wheels_of(log);
  if (wheels.empty()) return;
  std::size_t next = 0;  // the wheels' last reading until a pose is the one before
  std::optional<Common> last;
  for (const TrajectoryPose& pose : log.truth->poses()) {
    while (next < wheels.size() && wheels[next].stamp <= pose.stamp) ++next;
    if (next == 0) continue;
    if (next == wheels.size() && wheels.back().stamp < pose.stamp) break;
    if (last && seconds_between(last->stamp, pose.stamp) < kCommonStep_s) continue;
    const Common here{pose.stamp, pose.T_map_base.translation_m(),
                      wheels[next - 1].T_odom_base.translation_m()};
    if (last) {
      health.common_path_m += (here.true_m - last->true_m).norm();
      health.common_wheel_path_m += (here.wheels_m - last->wheels_m).norm();
    }
    last = here;
  }
}

}  // namespace

TruthHealth truth_health_of(const SensorLog& log, const LogLimits& limits) {
  TruthHealth health;
  health.num_poses = log.truth->size();
  health.path_m = log.truth->path_length_m();
  health.scans_with_pose_ratio = scans_with_pose_ratio(log);
  count_fast_steps(*log.truth, limits, health);
  compare_with_wheels(log, health);
  return health;
}

}  // namespace corridor::formats
