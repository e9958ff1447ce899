#include "bench/metrics/accuracy_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "datasets/simulation/ray_casting.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/core/units.hpp"
#include "slam/motion/imu_track.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::metrics {
namespace {

// Standard deviations of what is known before the log begins.
constexpr double kStart = 1e-5;  // the first pose is the frame
constexpr double kScale = 0.02, kUnbalance_radpm = 0.03, kTurn = 0.05;
constexpr double kSpeed_mps = 1;
constexpr double kGyroBias_radps = 0.01, kAccelBias_mps2 = 0.1, kGyroScale = 0.01;
constexpr double kSurface_m = 10, kSurface_rad = 3;
constexpr double kKnown = 1e-5;  // the wheels' clock and place
// Biases that do not walk still need a factor from scan to scan.
constexpr double kLeastWalk = 1e-7;
// A range further than this from the wall that a beam should have met is of something else.
constexpr double kSameSurface_sigma = 5;
// Poses whose covariance is computed; the mean of more of them says the same.
constexpr std::size_t kSampledPoses = 60;

// Variables beside those of the scans: a pose for each surface.
constexpr std::uint32_t kFirstSurface = 1u << 21;

double square(double x) { return x * x; }

// A wall: in its middle, along it. An arc: in its centre.
Pose2 frame_of(const simulation::World& world, std::size_t surface) {
  if (surface >= world.walls.size()) {
    const Eigen::Vector2d& centre = world.arcs[surface - world.walls.size()].centre_m;
    return {centre.x(), centre.y(), 0};
  }
  const simulation::Segment& wall = world.walls[surface];
  const Eigen::Vector2d middle = 0.5 * (wall.a_m + wall.b_m);
  const Eigen::Vector2d along = wall.b_m - wall.a_m;
  return {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
}

class InformationGraph {
 public:
  InformationGraph(const SensorLog& log, const simulation::World& world,
                   std::span<const simulation::SlipInterval> slips)
      : log_(log),
        world_(world),
        slips_(slips),
        caster_(world),
        imu_(log.robot.imu),
        back_end_(backend::make_isam2({})) {}

  void build() {
    add_priors();
    for (const SensorEvent& event : log_.events) {
      if (const auto* wheels = std::get_if<WheelSample>(&event)) wheels_.add(*wheels);
      if (const auto* imu = std::get_if<ImuSample>(&event)) imu_.add(*imu);
      if (const auto* scan = std::get_if<LaserScan>(&event)) add_scan(*scan);
    }
    back_end_->add(std::move(factors_), values_);
  }

  std::optional<AccuracyBound> bound() {
    if (num_scans_ < 2) return std::nullopt;
    const std::size_t step = (num_scans_ + kSampledPoses - 1) / kSampledPoses;
    double position_m2 = 0, angle_rad2 = 0;
    int num = 0;
    for (std::size_t k = (num_scans_ - 1) % step; k < num_scans_; k += step) {
      const auto covariance =
          back_end_->marginal_covariance(graph::pose_key(static_cast<std::uint32_t>(k)));
      if (!covariance || !covariance->allFinite()) return std::nullopt;
      position_m2 += (*covariance)(0, 0) + (*covariance)(1, 1);
      angle_rad2 += (*covariance)(2, 2);
      ++num;
    }
    return AccuracyBound{std::sqrt(position_m2 / num), std::sqrt(angle_rad2 / num) / kRadPerDeg};
  }

 private:
  void add_priors() {
    motion::WheelCalibration sigma = motion::WheelCalibration::Constant(kKnown);
    sigma(motion::kScale) = kScale;
    sigma(motion::kUnbalance) = kUnbalance_radpm;
    sigma(motion::kTurn) = kTurn;
    values_.set_wheel_calibration(0, motion::WheelCalibration::Zero());
    factors_.push_back(graph::WheelCalibrationPrior(0, motion::WheelCalibration::Zero(), sigma));
  }

  void add_scan(const LaserScan& scan) {
    const std::optional<Pose2> T_world_base = log_.truth->interpolate(scan.stamp);
    if (!T_world_base) return;
    const auto k = static_cast<std::uint32_t>(num_scans_++);
    values_.set_pose(k, *T_world_base);
    if (k == 0) {
      factors_.push_back(graph::PosePrior(graph::pose_key(0), *T_world_base,
                                          Eigen::Matrix3d::Identity() / kStart));
    }
    add_imu(k, scan.stamp);
    add_wheels(k, scan.stamp);
    add_surfaces(k, scan);
    last_stamp_ = scan.stamp;
  }

  // Once the IMU has spoken every scan has a velocity and a bias.
  void add_imu(std::uint32_t k, Timestamp stamp) {
    if (!imu_.has_reading()) return;
    imu_.advance_to(stamp);
    const motion::ImuDelta delta = imu_.delta();
    imu_.reset(motion::ImuBias::Zero());
    values_.set_velocity(k, velocity_mps(stamp));
    values_.set_bias(k, motion::ImuBias::Zero());
    if (!has_imu_) {
      factors_.push_back(
          graph::VelocityPrior(k, values_.velocity(k), Eigen::Vector2d::Constant(kSpeed_mps)));
      factors_.push_back(graph::BiasPrior(
          k, motion::ImuBias::Zero(),
          motion::ImuBias(kGyroBias_radps, kAccelBias_mps2, kAccelBias_mps2, kGyroScale)));
    } else {
      const ImuModel& model = log_.robot.imu;
      const double root_s = std::sqrt(delta.duration_s);
      const double gyro = std::max(model.gyro_bias_walk_radps_sqrt_s * root_s, kLeastWalk);
      const double accel = std::max(model.accel_bias_walk_mps2_sqrt_s * root_s, kLeastWalk);
      factors_.push_back(graph::ImuMotion(k - 1, k, delta));
      factors_.push_back(
          graph::BiasWalk(k - 1, k, motion::ImuBias(gyro, accel, accel, kLeastWalk)));
    }
    has_imu_ = true;
  }

  Eigen::Vector2d velocity_mps(Timestamp stamp) const {
    constexpr double kStep_s = 0.01;
    const Pose2 here = *log_.truth->interpolate(stamp);
    for (const double step_s : {kStep_s, -kStep_s}) {
      const auto there = log_.truth->interpolate(add_seconds(stamp, step_s));
      if (there) return (there->translation_m() - here.translation_m()) / step_s;
    }
    return Eigen::Vector2d::Zero();
  }

  bool do_wheels_slip(Timestamp begin, Timestamp end) const {
    return std::any_of(slips_.begin(), slips_.end(), [&](const simulation::SlipInterval& slip) {
      return slip.begin_s < to_seconds(end) && to_seconds(begin) < slip.end_s;
    });
  }

  // Both wheels' paths have noise of their own; the axle does not move sideways. What is not known
  // of a path is at least the rounding to ticks.
  void add_wheels(std::uint32_t k, Timestamp stamp) {
    const std::optional<motion::WheelReading> reading = wheels_.read(stamp, 0);
    if (k > 0 && reading && last_reading_ && !do_wheels_slip(last_stamp_, stamp)) {
      const WheelModel& model = log_.robot.wheels;
      const motion::WheelDelta delta =
          wheels_.between(*last_reading_, *reading, motion::WheelCalibration::Zero());
      const Pose2 moved = delta.raw_T_i_j();
      const double path_m = moved.translation_m().norm();
      const double half_turn_m = 0.5 * model.track_m * std::abs(moved.theta_rad());
      const double wheel_path_m = std::max(path_m, half_turn_m);
      const double tick_m = model.left_m_per_tick;
      const double variance_m2 =
          square(model.sigma_m_per_sqrt_m) * wheel_path_m + square(tick_m) / 6;
      const double forward_m = std::sqrt(variance_m2 / 2);
      const double turn_rad = std::sqrt(2 * variance_m2) / model.track_m;
      const double aside_m = 0.5 * path_m * turn_rad + tick_m;
      const Eigen::Vector3d weight(1 / forward_m, 1 / aside_m, 1 / turn_rad);
      factors_.push_back(graph::WheelMotion(graph::pose_key(k - 1), graph::pose_key(k),
                                            graph::wheel_calibration_key(0), delta,
                                            weight.asDiagonal()));
    }
    last_reading_ = reading;
  }

  // Of every surface that a scan sees, what its ranges say of the pose relative to it.
  void add_surfaces(std::uint32_t k, const LaserScan& scan) {
    std::map<std::size_t, Eigen::Matrix3d> information;  // right tangent of the base
    for (std::size_t beam = 0; beam < scan.num_beams(); ++beam) {
      if (scan.is_valid[beam] != 0) add_beam(scan, beam, information);
    }
    const Pose2& T_world_base = values_.pose(k);
    for (const auto& [surface, matrix] : information) {
      const auto index = kFirstSurface + static_cast<std::uint32_t>(surface);
      const Pose2 T_world_surface = frame_of(world_, surface);
      if (!values_.contains(graph::pose_key(index))) add_frame(index, T_world_surface);
      factors_.push_back(graph::RelativePose(graph::pose_key(index), graph::pose_key(k),
                                             T_world_surface.between(T_world_base),
                                             graph::square_root_information(matrix)));
    }
  }

  void add_frame(std::uint32_t index, const Pose2& T_world_surface) {
    values_.set_pose(index, T_world_surface);
    const Eigen::Vector3d weight(1 / kSurface_m, 1 / kSurface_m, 1 / kSurface_rad);
    factors_.push_back(
        graph::PosePrior(graph::pose_key(index), T_world_surface, weight.asDiagonal()));
  }

  // n . (p + rho u) is the surface's place along its normal n: d rho = -n . d p / (n . u).
  void add_beam(const LaserScan& scan, std::size_t beam,
                std::map<std::size_t, Eigen::Matrix3d>& information) const {
    const auto T_world_base =
        log_.truth->interpolate(add_seconds(scan.stamp, scan.beam_time_s(beam)));
    if (!T_world_base) return;
    const double sigma_m = log_.robot.lidar.range_sigma_m;
    const Pose2 T_world_lidar = *T_world_base * scan.T_base_lidar;
    const double direction_rad = T_world_lidar.theta_rad() + scan.angle_rad(beam);
    const auto hit = caster_.cast(T_world_lidar.translation_m(), direction_rad,
                                  scan.range_max_m + kSameSurface_sigma * sigma_m);
    if (!hit || std::abs(hit->range_m - static_cast<double>(scan.ranges_m[beam])) >
                    kSameSurface_sigma * sigma_m) {
      return;
    }
    const Eigen::Vector2d u(std::cos(direction_rad), std::sin(direction_rad));
    const Eigen::Vector2d point_m = T_world_lidar.translation_m() + hit->range_m * u;
    const Eigen::Vector2d n = world_.normal(hit->surface_index, point_m);
    const Eigen::Vector2d n_base = T_world_base->rotation().transpose() * n;
    const Eigen::Vector2d point_base_m = T_world_base->inverse() * point_m;
    const double turn = n_base.y() * point_base_m.x() - n_base.x() * point_base_m.y();
    const Eigen::Vector3d row =
        Eigen::Vector3d(n_base.x(), n_base.y(), turn) / (sigma_m * n.dot(u));
    const auto place = information.try_emplace(hit->surface_index, Eigen::Matrix3d::Zero()).first;
    place->second += row * row.transpose();
  }

  const SensorLog& log_;
  const simulation::World& world_;
  std::span<const simulation::SlipInterval> slips_;
  simulation::RayCaster caster_;
  motion::ImuTrack imu_;
  motion::WheelTrack wheels_;
  std::optional<motion::WheelReading> last_reading_;
  Timestamp last_stamp_;
  bool has_imu_ = false;
  std::size_t num_scans_ = 0;
  graph::Values values_;
  std::vector<graph::NewFactor> factors_;
  std::unique_ptr<backend::BackEnd> back_end_;
};

}  // namespace

std::optional<AccuracyBound> accuracy_bound(const SensorLog& log, const simulation::World& world,
                                            std::span<const simulation::SlipInterval> slips) {
  if (!log.truth || log.robot.lidar.range_sigma_m <= 0) return std::nullopt;
  InformationGraph graph(log, world, slips);
  graph.build();
  return graph.bound();
}

}  // namespace corridor::metrics
