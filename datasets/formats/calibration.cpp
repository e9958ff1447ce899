#include "datasets/formats/calibration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "datasets/formats/median.hpp"
#include "datasets/formats/robot_toml.hpp"

namespace corridor::formats {
namespace {

// Poses that differ by less are the same mounting, printed with few digits.
constexpr double kSamePose_m = 1e-3;
constexpr double kSamePose_rad = 2e-3;
// A limit kept as a 32-bit float is the same limit.
constexpr double kSameRange_ratio = 1e-6;

constexpr std::string_view kRangeMin = "lidar.range_min_m";
constexpr std::string_view kRangeMax = "lidar.range_max_m";
constexpr std::string_view kRangeSigma = "lidar.range_sigma_m";
constexpr std::string_view kScanDuration = "lidar.scan_duration_s";

bool is_same_pose(const Pose2& a, const Pose2& b) {
  const Pose2::Tangent difference = a.minus(b);
  return difference.head<2>().norm() < kSamePose_m && std::abs(difference.z()) < kSamePose_rad;
}

std::string pose_text(const Pose2& pose) {
  return fmt::format("({:.4f} m, {:.4f} m, {:.4f} rad)", pose.x_m(), pose.y_m(), pose.theta_rad());
}

template <class Function>
void for_each_scan(ParsedLog& log, Function function) {
  for (SensorEvent& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) function(*scan);
  }
}

const LaserScan* first_scan(const ParsedLog& log) {
  for (const SensorEvent& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) return scan;
  }
  return nullptr;
}

double median_duration_s(ParsedLog& log) {
  std::vector<double> durations_s;
  for_each_scan(log, [&](const LaserScan& scan) { durations_s.push_back(scan.duration_s); });
  return upper_median(std::move(durations_s));
}

// The log's own model, or the caller's.
Result<StatedRobot> model_of_log(const ParsedLog& log, const CalibrationSources& sources) {
  if (!log.robot_toml) {
    return StatedRobot{sources.caller.value_or(RobotModel{}), sources.caller_keys};
  }
  return robot_from_toml(*log.robot_toml, sources.file + ": robot model in the leading comment");
}

// The scans say where their beams point; CARMEN's FLASER lines do not and have the identity.
void reconcile_lidar_pose(ParsedLog& log, const RobotKeys& own_keys, StatedRobot& stated,
                          std::vector<std::string>& notes) {
  Pose2& T_base_lidar = stated.robot.lidar.T_base_lidar;
  const Pose2 T_scans = first_scan(log)->T_base_lidar;
  if (!log.scans_state_pose) {
    for_each_scan(log, [&](LaserScan& scan) { scan.T_base_lidar = T_base_lidar; });
    return;
  }
  if (states_any(own_keys, kLidarPoseKeys) && !is_same_pose(T_scans, T_base_lidar)) {
    notes.push_back(
        fmt::format("the robot model places the LiDAR at {}, the scans at {}: the scans' is used",
                    pose_text(T_base_lidar), pose_text(T_scans)));
  }
  T_base_lidar = T_scans;
  stated.keys.insert(kLidarPoseKeys.begin(), kLidarPoseKeys.end());
}

void reconcile_range_max(ParsedLog& log, const RobotKeys& own_keys, StatedRobot& stated,
                         std::vector<std::string>& notes) {
  const double scans_m = first_scan(log)->range_max_m;
  const double model_m = stated.robot.lidar.range_max_m;
  const bool is_stated = states(own_keys, kRangeMax);
  if (log.scans_state_range_max) stated.keys.emplace(kRangeMax);
  if (is_stated && std::abs(scans_m - model_m) <= kSameRange_ratio * model_m) {
    for_each_scan(log, [&](LaserScan& scan) {
      if (scan.range_max_m == scans_m) scan.range_max_m = model_m;
    });
    return;
  }
  if (is_stated) {
    notes.push_back(
        fmt::format("the robot model's LiDAR reaches {} m, the scans' {} m: the scans' is used",
                    model_m, scans_m));
  }
  stated.robot.lidar.range_max_m = scans_m;
}

// What the log states of its scans goes before the model's, with a note where both speak.
void reconcile_range_min(const std::optional<double>& log_m, const RobotKeys& own_keys,
                         StatedRobot& stated, std::vector<std::string>& notes) {
  if (!log_m) return;
  stated.keys.emplace(kRangeMin);
  double& model_m = stated.robot.lidar.range_min_m;
  if (std::abs(*log_m - model_m) <= kSameRange_ratio * model_m) return;
  if (states(own_keys, kRangeMin)) {
    notes.push_back(
        fmt::format("the robot model's minimum range [m] is {}, the scans' {}: the scans' is used",
                    model_m, *log_m));
  }
  model_m = *log_m;
}

// The noise that scans state fills what no model says.
void fill_range_sigma(const StatedNoise& noise, StatedRobot& stated) {
  if (!noise.sigma_m || noise.varies || !StatedNoise::is_sensible(*noise.sigma_m)) return;
  stated.robot.lidar.range_sigma_m = *noise.sigma_m;
  stated.keys.emplace(kRangeSigma);
}

// The readings say where the IMU sits.
void reconcile_imu_pose(const std::optional<Pose2>& T_readings, const RobotKeys& own_keys,
                        StatedRobot& stated, std::vector<std::string>& notes) {
  if (!T_readings) return;
  Pose2& T_base_imu = stated.robot.imu.T_base_imu;
  if (states_any(own_keys, kImuPoseKeys) && !is_same_pose(*T_readings, T_base_imu)) {
    notes.push_back(fmt::format(
        "the robot model places the IMU at {}, the readings at {}: the readings' is used",
        pose_text(T_base_imu), pose_text(*T_readings)));
  }
  T_base_imu = *T_readings;
  stated.keys.insert(kImuPoseKeys.begin(), kImuPoseKeys.end());
}

// Scans that state their durations lend the model their median.
void reconcile_scan_duration(ParsedLog& log, const RobotKeys& own_keys, StatedRobot& stated,
                             std::vector<std::string>& notes) {
  if (!log.scans_state_duration || first_scan(log) == nullptr) return;
  const double median_s = median_duration_s(log);
  const double model_s = stated.robot.lidar.scan_duration_s;
  if (states(own_keys, kScanDuration) && median_s != model_s) {
    notes.push_back(fmt::format(
        "the robot model's scan duration is {} s, the scans' median {} s: each scan's is used",
        model_s, median_s));
  }
  stated.robot.lidar.scan_duration_s = median_s;
  stated.keys.emplace(kScanDuration);
}

// A calibration knows better than a driver, but what the driver said is not kept.
void count_other_noise(const LidarModel& lidar, ParsedLog& log) {
  const StatedNoise& stated = log.stated_noise;
  const double model_m = lidar.range_sigma_m;
  if (!stated.sigma_m) return;
  if (!stated.varies && std::abs(*stated.sigma_m - model_m) <= kSameRange_ratio * model_m) return;
  const std::string values = stated.varies
                                 ? "accuracies that differ"
                                 : fmt::format("an accuracy of {:.4g} m", *stated.sigma_m);
  std::size_t num_scans = 0;
  for_each_scan(log, [&num_scans](const LaserScan&) { ++num_scans; });
  log.left_out[fmt::format("scans state {}, not kept: range_sigma_m is {} m", values, model_m)] =
      num_scans;
}

// A sidecar may shorten the sensor's reach: longer beams become beams without return.
void apply_sidecar_range(ParsedLog& log, double range_max_m, std::vector<std::string>& notes) {
  std::size_t num_cut = 0;
  for_each_scan(log, [&](LaserScan& scan) {
    scan.range_max_m = range_max_m;
    for (std::size_t i = 0; i < scan.num_beams(); ++i) {
      if (scan.is_valid[i] != 0 && scan.ranges_m[i] > range_max_m) {
        scan.is_valid[i] = 0;
        ++num_cut;
      }
    }
  });
  notes.push_back(
      fmt::format("{} beams beyond the sidecar's {} m taken as no return", num_cut, range_max_m));
}

void apply_sidecar_pose(ParsedLog& log, const Pose2& T_base_lidar,
                        std::vector<std::string>& notes) {
  const Pose2 T_scans = first_scan(log)->T_base_lidar;
  for_each_scan(log, [&](LaserScan& scan) { scan.T_base_lidar = T_base_lidar; });
  if (!is_same_pose(T_scans, T_base_lidar)) {
    notes.push_back(fmt::format("LiDAR placed at {} by the sidecar, at {} by the log",
                                pose_text(T_base_lidar), pose_text(T_scans)));
  }
}

Result<void> apply_sidecar(ParsedLog& log, const CalibrationSources& sources, StatedRobot& stated,
                           std::vector<std::string>& notes) {
  auto read = override_robot(stated.robot, *sources.sidecar_toml, sources.sidecar_file);
  if (!read) return tl::make_unexpected(read.error());
  const RobotKeys& keys = read->keys;
  const double log_range_max_m = stated.robot.lidar.range_max_m;
  const RobotModel& robot = stated.robot = std::move(read->robot);
  stated.keys.insert(keys.begin(), keys.end());
  notes.push_back("calibration from " + sources.sidecar_file);
  if (first_scan(log) == nullptr) return {};
  if (states_any(keys, kLidarPoseKeys)) apply_sidecar_pose(log, robot.lidar.T_base_lidar, notes);
  if (states(keys, kRangeMax) && robot.lidar.range_max_m != log_range_max_m) {
    apply_sidecar_range(log, robot.lidar.range_max_m, notes);
  }
  if (states(keys, kScanDuration) && log.scans_state_duration) {
    log.scans_state_duration = false;
    notes.push_back(fmt::format("every sweep takes {} s by the sidecar, {} s by the log's median",
                                robot.lidar.scan_duration_s, median_duration_s(log)));
  }
  return {};
}

// Clockwise scans are stamped at the beam that is last: a duration alone would move them.
Result<void> check_clockwise(const ParsedLog& log, const CalibrationSources& sources,
                             double scan_duration_s) {
  if (!log.has_clockwise_scans || log.scans_state_duration || scan_duration_s == 0) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("lidar.scan_duration_s = {} for clockwise scans without times of their "
                          "beams",
                          scan_duration_s),
              sources.sidecar_toml ? sources.sidecar_file : "the robot model",
              "time_increment in the messages, and no scan_duration_s");
}

}  // namespace

Result<StatedRobot> calibrate(ParsedLog& log, const CalibrationSources& sources,
                              std::vector<std::string>& notes) {
  auto model = model_of_log(log, sources);
  if (!model) return tl::make_unexpected(model.error());
  StatedRobot stated = std::move(*model);
  // The caller's model contradicts nothing: it only fills what is not there.
  const RobotKeys own_keys = log.robot_toml ? stated.keys : RobotKeys{};
  if (first_scan(log) != nullptr) {
    reconcile_lidar_pose(log, own_keys, stated, notes);
    reconcile_range_max(log, own_keys, stated, notes);
    reconcile_range_min(log.range_min_m, own_keys, stated, notes);
    const bool has_model = states(own_keys, kRangeSigma) || sources.caller.has_value();
    if (!has_model) fill_range_sigma(log.stated_noise, stated);
  }
  reconcile_imu_pose(log.T_base_imu, own_keys, stated, notes);
  if (sources.sidecar_toml) {
    if (auto applied = apply_sidecar(log, sources, stated, notes); !applied) {
      return tl::make_unexpected(applied.error());
    }
  }
  count_other_noise(stated.robot.lidar, log);
  if (log.is_time_offset_applied) {
    stated.applied_time_offset_s = std::exchange(stated.robot.lidar.time_offset_s, 0);
  }
  reconcile_scan_duration(log, own_keys, stated, notes);
  const LidarModel& lidar = stated.robot.lidar;
  if (auto good = check_clockwise(log, sources, lidar.scan_duration_s); !good) {
    return tl::make_unexpected(good.error());
  }
  for_each_scan(log, [&](LaserScan& scan) {
    scan.range_min_m = lidar.range_min_m;
    if (!log.scans_state_duration) scan.duration_s = lidar.scan_duration_s;
  });
  return stated;
}

}  // namespace corridor::formats
