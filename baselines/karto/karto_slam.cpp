#include "baselines/karto/karto_slam.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "baselines/karto/correlative_matcher.hpp"
#include "baselines/karto/key_scan_rule.hpp"
#include "baselines/karto/mapper.hpp"
#include "baselines/karto/occupancy_rule.hpp"
#include "slam/core/expect.hpp"
#include "slam/motion/dense_path.hpp"
#include "slam/motion/gyro_odometry.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::karto {
namespace {

// The original's threshold for a sensor it does not know [m].
constexpr double kMaxDefaultThreshold_m = 12.0;

StepReport nothing_to_do(Timestamp stamp) {
  StepReport report;
  report.stamp = stamp;
  return report;
}

ScanMatcher make_correlative_matcher(const GridSpec& spec, const KartoParams& params) {
  const auto matcher = std::make_shared<CorrelativeMatcher>(spec, params);
  return [matcher](const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                   std::span<const KeyScan* const> local_map, const MatchOptions& options) {
    return matcher->match(scan, T_map_sensor_predicted, local_map, options);
  };
}

double range_threshold_of(const KartoParams& params, const RobotModel& robot,
                          const LaserScan& scan) {
  if (params.range_threshold_m > 0) return params.range_threshold_m;
  double threshold_m = std::min(kMaxDefaultThreshold_m, robot.lidar.range_max_m);
  if (std::isfinite(scan.range_max_m) && scan.range_max_m > 0) {
    threshold_m = std::min(threshold_m, scan.range_max_m);
  }
  return threshold_m;
}

}  // namespace

class KartoSlam::Impl {
 public:
  Impl(const KartoParams& params, const RobotModel& robot,
       std::unique_ptr<backend::BackEnd> back_end, int num_threads, StageClock& clock)
      : params_(params),
        robot_(robot),
        gyro_odometry_(robot),
        back_end_(std::move(back_end)),
        num_threads_(num_threads),
        clock_(clock) {
    CORRIDOR_EXPECT(back_end_ != nullptr);
    CORRIDOR_EXPECT(param_violations(params).empty());
  }

  StepReport take(const WheelSample& sample) {
    const auto in_stage = clock_.enter(Stage::kPredict);
    wheels_.add(params_.use_gyro_odometry ? gyro_odometry_.corrected(sample) : sample);
    return nothing_to_do(sample.stamp);
  }

  StepReport take(const ImuSample& sample) {
    const auto in_stage = clock_.enter(Stage::kPredict);
    if (params_.use_gyro_odometry) gyro_odometry_.add(sample);
    return nothing_to_do(sample.stamp);
  }

  StepReport take(const LaserScan& scan) {
    update_odometry(scan.stamp);
    records_.push_back({scan.stamp, T_odom_base_.value_or(Pose2{}), false});
    if (T_odom_base_) consider(scan);
    return report(scan.stamp);
  }

  Result<SlamEstimate> finish() {
    const auto in_stage = clock_.enter(Stage::kFinish);
    Result<SlamEstimate> estimate;
    if (records_.empty()) return estimate;
    if (!T_map_start_) {
      return fail(ErrorCode::kInvalid, "no wheel odometry near any scan", "sensor log",
                  "wheel samples");
    }
    if (mapper_) mapper_->publish_poses();
    estimate->trajectory = final_trajectory();
    estimate->map = mapper_ ? build_karto_map(mapper_->scans(), T_map_start_->inverse(),
                                              range_threshold_m_, params_)
                            : GridMap{};
    estimate->counters = counters();
    return estimate;
  }

  [[nodiscard]] const PoseGraph* pose_graph() const {
    return mapper_ ? &mapper_->pose_graph() : nullptr;
  }
  // Of a run that never had a key scan.
  [[nodiscard]] const backend::BackEnd& unused_back_end() const { return *back_end_; }
  [[nodiscard]] std::vector<Timestamp> key_stamps() const {
    std::vector<Timestamp> stamps;
    for (const motion::ScanRecord& record : records_) {
      if (record.is_key) stamps.push_back(record.stamp);
    }
    return stamps;
  }

 private:
  void update_odometry(Timestamp stamp) {
    const auto in_stage = clock_.enter(Stage::kPredict);
    if (const auto T_odom_base = wheels_.pose_at(stamp)) {
      T_odom_base_ = T_odom_base;
      if (!T_map_start_) start_at(*T_odom_base);
    } else {
      ++num_without_odometry_;
    }
  }

  // Scans seen before any odometry count as taken here.
  void start_at(const Pose2& T_odom_base) {
    T_map_start_ = T_odom_base;
    for (motion::ScanRecord& record : records_) record.T_odom_base = T_odom_base;
  }

  // Makes a key scan of it if it is worth one.
  void consider(const LaserScan& scan) {
    std::optional<KeyScan> candidate;
    {
      const auto in_stage = clock_.enter(Stage::kPreprocess);
      if (!mapper_) range_threshold_m_ = range_threshold_of(params_, robot_, scan);
      candidate.emplace(
          scan, *T_odom_base_,
          KeyScanOptions{range_threshold_m_, params_.use_barycentre, params_.count_no_returns});
    }
    if (!candidate->is_usable()) {
      ++num_unusable_;
      return;
    }
    if (!mapper_) {
      mapper_.emplace(params_, range_threshold_m_, PoseGraph(std::move(back_end_), *T_map_start_),
                      clock_, num_threads_, make_correlative_matcher);
    } else if (!is_key_scan(mapper_->scans().back(), *candidate, params_)) {
      return;
    } else {
      candidate->set_T_map_sensor(predicted_T_map_base() * scan.T_base_lidar);
    }
    mapper_->add(std::move(*candidate));
    T_odom_last_key_ = *T_odom_base_;
    records_.back().is_key = true;
  }

  // The last key scan's pose, carried on by odometry.
  [[nodiscard]] Pose2 predicted_T_map_base() const {
    return mapper_->scans().back().T_map_base() * T_odom_last_key_.between(*T_odom_base_);
  }

  // In the frame of the first scan. Before any odometry: where the robot will be found standing.
  [[nodiscard]] Pose2 online_pose() const {
    if (!T_odom_base_) return {};
    const Pose2 T_map_base = mapper_ ? predicted_T_map_base() : *T_odom_base_;
    return T_map_start_->between(T_map_base);
  }

  [[nodiscard]] StepReport report(Timestamp stamp) const {
    StepReport report = nothing_to_do(stamp);
    report.status = StepStatus::kTracked;
    report.T_map_base = online_pose();
    report.is_key_scan = records_.back().is_key;
    return report;
  }

  // A log may begin with scans that were no key scans: odometry carries back from the first one.
  [[nodiscard]] Trajectory final_trajectory() const {
    std::vector<motion::ScanRecord> records = records_;
    std::vector<Pose2> key_poses;
    if (!records.front().is_key) {
      records.front().is_key = true;
      key_poses.push_back(T_map_start_->between(records.front().T_odom_base));
    }
    if (mapper_) {
      for (const KeyScan& scan : mapper_->scans()) {
        key_poses.push_back(T_map_start_->between(scan.T_map_base()));
      }
    }
    return motion::dense_path(records, key_poses);
  }

  [[nodiscard]] std::map<std::string, double> counters() const {
    std::map<std::string, double> totals = {
        {"key_scans", mapper_ ? static_cast<double>(mapper_->scans().size()) : 0.0},
        {"unusable_scans", num_unusable_},
        {"scans_without_odometry", num_without_odometry_}};
    if (!mapper_) return totals;
    const MapperCounters& mapper = mapper_->counters();
    totals["sequential_matches"] = mapper.sequential_matches;
    totals["near_chain_matches"] = mapper.near_chain_matches;
    totals["near_chain_links"] = mapper.near_chain_links;
    totals["coarse_loop_matches"] = mapper.coarse_loop_matches;
    totals["fine_loop_matches"] = mapper.fine_loop_matches;
    totals["loop_closures"] = mapper.loop_closures;
    totals["failed_solves"] = mapper.failed_solves;
    if (mapper.dropped_factors > 0) {
      totals["dropped_factors"] = static_cast<double>(mapper.dropped_factors);
    }
    totals["factors"] = static_cast<double>(mapper_->pose_graph().factors().num_factors());
    return totals;
  }

  KartoParams params_;
  RobotModel robot_;
  motion::GyroOdometry gyro_odometry_;
  std::unique_ptr<backend::BackEnd> back_end_;
  int num_threads_;
  StageClock& clock_;
  motion::WheelTrack wheels_;
  std::optional<Pose2> T_odom_base_;
  // First odometry pose: the mapper works in the frame of odometry, as the original, whose results
  // depend on how its grids lie; what leaves this class is in the frame of the first scan.
  std::optional<Pose2> T_map_start_;
  double range_threshold_m_ = 0;
  std::optional<Mapper> mapper_;
  std::vector<motion::ScanRecord> records_;
  Pose2 T_odom_last_key_;
  int num_unusable_ = 0;
  int num_without_odometry_ = 0;
};

KartoSlam::KartoSlam(const KartoParams& params, const RobotModel& robot,
                     std::unique_ptr<backend::BackEnd> back_end, int num_threads)
    : impl_(
          std::make_unique<Impl>(params, robot, std::move(back_end), num_threads, stage_clock())) {}

KartoSlam::~KartoSlam() = default;

Result<StepReport> KartoSlam::on_event(const SensorEvent& event) {
  if (const auto* wheels = std::get_if<WheelSample>(&event)) return impl_->take(*wheels);
  if (const auto* scan = std::get_if<LaserScan>(&event)) return impl_->take(*scan);
  return impl_->take(std::get<ImuSample>(event));
}

Result<SlamEstimate> KartoSlam::finish() { return impl_->finish(); }

const graph::FactorGraph& KartoSlam::solved_graph() const {
  const PoseGraph* pose_graph = impl_->pose_graph();
  return pose_graph != nullptr ? pose_graph->factors() : impl_->unused_back_end().graph();
}

std::vector<Timestamp> KartoSlam::pose_stamps() const { return impl_->key_stamps(); }

const graph::Values& KartoSlam::solved_values() const {
  const PoseGraph* pose_graph = impl_->pose_graph();
  return pose_graph != nullptr ? pose_graph->values() : impl_->unused_back_end().estimate();
}

std::unique_ptr<SlamSystem> make_karto(const KartoParams& params, const RobotModel& robot,
                                       std::unique_ptr<backend::BackEnd> back_end,
                                       int num_threads) {
  return std::make_unique<KartoSlam>(params, robot, std::move(back_end), num_threads);
}

}  // namespace corridor::karto
