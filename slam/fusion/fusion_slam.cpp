#include "slam/fusion/fusion_slam.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "slam/fusion/interval_factors.hpp"
#include "slam/fusion/local_map.hpp"
#include "slam/fusion/loop_closer.hpp"
#include "slam/fusion/motion_predictor.hpp"
#include "slam/fusion/scan_tracker.hpp"
#include "slam/graph/factors/pose_factors.hpp"
#include "slam/graph/graph_source.hpp"
#include "slam/motion/deskew.hpp"

namespace corridor::fusion {
namespace {

// A prediction that contradicts this many scans in a row is itself the wrong one.
constexpr int kMaxRefusedInARow = 3;

// Where a scan lies on the key scan before it.
struct ScanRecord {
  Timestamp stamp;
  std::uint32_t key;
  Pose2 T_key_base;
};

class FusionSlam final : public SlamSystem, public graph::GraphSource {
 public:
  FusionSlam(const FusionParams& params, const RobotModel& robot,
             std::unique_ptr<backend::BackEnd> back_end)
      : params_(params),
        robot_(robot),
        back_end_(std::move(back_end)),
        predictor_(robot_, params_),
        local_map_(params_),
        loop_closer_(params_),
        wheel_noise_(params.max_wheel_noise_factor) {}

  std::string_view name() const override {
    return params_.use_directional_degeneracy ? "fusion" : "fusion-paper";
  }
  const graph::FactorGraph& solved_graph() const override { return back_end_->graph(); }
  const graph::Values& solved_values() const override { return back_end_->estimate(); }

  Result<StepReport> on_event(const SensorEvent& event) override {
    StepReport report;
    report.stamp = stamp_of(event);
    if (const auto* scan = std::get_if<LaserScan>(&event)) return on_scan(*scan);
    const auto stage = stage_clock().enter(Stage::kPreprocess);
    if (const auto* wheels = std::get_if<WheelSample>(&event)) predictor_.add(*wheels);
    if (const auto* imu = std::get_if<ImuSample>(&event)) predictor_.add(*imu);
    return report;
  }

  Result<SlamEstimate> finish() override {
    SlamEstimate result;
    if (key_scans_.empty()) return result;
    {
      const auto stage = stage_clock().enter(Stage::kOptimise);
      last_report_ = back_end_->solve();
      num_relinearized_ += last_report_.num_relinearized;
    }
    result.trajectory = smoothed_trajectory();
    {
      const auto stage = stage_clock().enter(Stage::kMapUpdate);
      std::vector<mapping::PosedScan> scans;
      for (std::uint32_t k = 0; k < key_scans_.size(); ++k) {
        scans.push_back({estimate().pose(k), &key_scans_[k].scan});
      }
      result.map = mapping::build_occupancy_map(scans, params_.map);
    }
    fill_counters(result.counters);
    return result;
  }

 private:
  const graph::Values& estimate() const { return back_end_->estimate(); }
  std::uint32_t last_key() const { return static_cast<std::uint32_t>(key_scans_.size() - 1); }
  const Eigen::Vector3d& last_bias() const { return estimate().bias(last_key()); }

  // One scan: predict, match, and at key scans choose factors, solve, extend the map, close loops.
  StepReport on_scan(const LaserScan& scan) {
    StepReport report;
    report.stamp = scan.stamp;
    report.status = StepStatus::kTracked;
    const Prediction prediction = predict(scan.stamp);
    std::vector<Eigen::Vector2d> points = preprocess(scan, prediction);
    if (key_scans_.empty()) {
      start(scan, std::move(points));
      report.is_key_scan = true;
    } else {
      const TrackedScan tracked = track(points, prediction);
      if (is_key_scan(scan.stamp)) {
        add_key_scan(scan, std::move(points), tracked);
        close_loops();
        report.is_key_scan = true;
      }
    }
    records_.push_back({scan.stamp, last_key(), estimate().pose(last_key()).between(T_map_base_)});
    last_scan_stamp_ = scan.stamp;
    if (!is_solved()) report.status = StepStatus::kLost;
    report.T_map_base = T_map_base_;
    report.is_slip_detected = verdict_.is_slip;
    report.is_degenerate = verdict_.is_degenerate;
    return report;
  }

  bool is_solved() const {
    return last_report_.status == backend::SolveStatus::kConverged ||
           last_report_.status == backend::SolveStatus::kMaxIterations;
  }

  Prediction predict(Timestamp stamp) {
    const auto stage = stage_clock().enter(Stage::kPredict);
    const double scale = key_scans_.empty() ? 0 : estimate().wheel_scale(0);
    return predictor_.predict(stamp, scale, wheel_noise_.factor());
  }

  std::vector<Eigen::Vector2d> preprocess(const LaserScan& scan, const Prediction& prediction) {
    const auto stage = stage_clock().enter(Stage::kPreprocess);
    const double dt = key_scans_.empty() ? 0 : seconds_between(last_scan_stamp_, scan.stamp);
    const Eigen::Vector3d twist =
        dt > 0 ? Eigen::Vector3d(prediction.T_last_now.log() / dt) : Eigen::Vector3d::Zero();
    return motion::deskewed_points(scan, twist, params_.max_range_m);
  }

  void start(const LaserScan& scan, std::vector<Eigen::Vector2d> points) {
    has_imu_ = predictor_.has_imu();
    if (!has_imu_) predictor_.ignore_imu();
    graph::Values values;
    values.set_pose(0, Pose2());
    values.set_wheel_scale(0, 0);
    if (has_imu_) {
      values.set_velocity(0, Eigen::Vector2d::Zero());
      values.set_bias(0, Eigen::Vector3d::Zero());
    }
    std::vector<graph::FactorPtr> factors;
    add_first_factors(has_imu_, params_, factors);
    last_report_ = back_end_->update(std::move(factors), values, {});
    key_scans_.push_back({scan, std::move(points), predictor_.wheel_pose_at(scan.stamp), 0});
    extend_map();
    begin_interval(scan.stamp);
    anchor_stamp_ = scan.stamp;
  }

  TrackedScan track(std::span<const Eigen::Vector2d> points, const Prediction& prediction) {
    const auto stage = stage_clock().enter(Stage::kMatch);
    Submap& submap = local_map_.active();
    const Pose2& T_map_submap = estimate().pose(submap.origin_key());
    const TrackedScan tracked =
        track_scan(submap, points, T_map_submap.between(T_map_base_), prediction, robot_, params_,
                   num_refused_in_a_row_ < kMaxRefusedInARow);
    num_refused_in_a_row_ = tracked.is_refused ? num_refused_in_a_row_ + 1 : 0;
    const Pose2 before = T_map_base_;
    T_map_base_ = T_map_submap * tracked.T_submap_base;
    path_m_ += (T_map_base_.translation_m() - before.translation_m()).norm();
    if (tracked.chi2 && tracked.degrees_of_freedom > 0) {
      is_wheel_jump_ =
          is_wheel_jump_ || (tracked.degrees_of_freedom == 3 && *tracked.chi2 > params_.slip_gate);
      if (params_.use_directional_degeneracy) {
        wheel_noise_.observe(*tracked.chi2 / tracked.degrees_of_freedom);
      }
    }
    return tracked;
  }

  bool is_key_scan(Timestamp stamp) const {
    const Pose2 moved = estimate().pose(last_key()).between(T_map_base_);
    const double age_s = seconds_between(key_scans_.back().scan.stamp, stamp);
    return moved.translation_m().norm() >= params_.key_distance_m ||
           std::abs(moved.theta_rad()) >= params_.key_angle_rad ||
           (has_imu_ && age_s >= params_.key_interval_s);
  }

  Interval interval_to(const LaserScan& scan, const TrackedScan& tracked) const {
    Interval interval;
    interval.i = last_key();
    interval.j = interval.i + 1;
    const KeyScan& before = key_scans_.back();
    const std::optional<Pose2> wheels = predictor_.wheel_pose_at(scan.stamp);
    if (before.wheel_T_odom_base && wheels) {
      interval.wheel_T_i_j = before.wheel_T_odom_base->between(*wheels);
    }
    interval.tracked_T_i_j = estimate().pose(interval.i).between(T_map_base_);
    if (has_imu_) {
      interval.imu = predictor_.imu_interval();
      interval.velocity_base_i_mps =
          estimate().pose(interval.i).rotation().transpose() * estimate().velocity(interval.i);
    }
    interval.match = tracked.match;
    interval.anchor = const_cast<LocalMap&>(local_map_).active().origin_key();
    interval.is_wheel_jump = is_wheel_jump_;
    interval.range_difference_m =
        mean_range_difference_m(before.scan, scan, interval.tracked_T_i_j.theta_rad());
    interval.wheel_scale = estimate().wheel_scale(0);
    interval.velocity_sigma_mps =
        is_velocity_known_ ? params_.velocity_sigma_mps : params_.initial_velocity_sigma_mps;
    interval.anchor_age_s = seconds_between(anchor_stamp_, scan.stamp);
    return interval;
  }

  void add_key_scan(const LaserScan& scan, std::vector<Eigen::Vector2d> points,
                    const TrackedScan& tracked) {
    {
      const auto stage = stage_clock().enter(Stage::kGraph);
      const Interval interval = interval_to(scan, tracked);
      std::vector<graph::FactorPtr> factors;
      verdict_ = add_interval_factors(interval, robot_, wheel_noise_.factor(), params_, factors);
      count_verdict();
      arrivals_.push_back(estimate().pose(interval.i).between(T_map_base_));
      const graph::Values values = initial_values(interval);
      const auto optimise = stage_clock().enter(Stage::kOptimise);
      last_report_ = back_end_->update(std::move(factors), values, {});
      num_relinearized_ += last_report_.num_relinearized;
      num_failed_solves_ += is_solved() ? 0 : 1;
    }
    if (verdict_.are_wheels_used || !verdict_.is_degenerate) {
      anchor_stamp_ = scan.stamp;
      is_velocity_known_ = true;
    }
    key_scans_.push_back({scan, std::move(points), predictor_.wheel_pose_at(scan.stamp), path_m_});
    T_map_base_ = estimate().pose(last_key());
    extend_map();
    begin_interval(scan.stamp);
  }

  graph::Values initial_values(const Interval& interval) const {
    graph::Values values;
    values.set_pose(interval.j, T_map_base_);
    if (has_imu_) {
      const Eigen::Vector2d gained =
          interval.imu
              ? Eigen::Vector2d(estimate().pose(interval.i).rotation() * interval.imu->velocity_mps)
              : Eigen::Vector2d::Zero();
      values.set_velocity(interval.j, estimate().velocity(interval.i) + gained);
      values.set_bias(interval.j, estimate().bias(interval.i));
    }
    return values;
  }

  void extend_map() {
    const auto stage = stage_clock().enter(Stage::kMapUpdate);
    local_map_.insert(last_key(), estimate(), key_scans_.back().points_base_m);
  }

  void begin_interval(Timestamp stamp) {
    is_wheel_jump_ = false;
    predictor_.reset_interval(stamp, has_imu_ ? last_bias() : Eigen::Vector3d::Zero());
  }

  void close_loops() {
    if (!params_.use_loop_closing) return;
    const auto stage = stage_clock().enter(Stage::kLoopSearch);
    const std::vector<LoopClosure> closures =
        loop_closer_.search(key_scans_, local_map_, estimate(), robot_.lidar.range_sigma_m);
    if (closures.empty()) return;
    std::vector<graph::FactorPtr> factors;
    for (const LoopClosure& closure : closures) {
      if (!closed_keys_.insert(closure.scan_key).second) continue;
      factors.push_back(std::make_unique<graph::RelativePose>(
          graph::pose_key(closure.submap_key), graph::pose_key(closure.scan_key),
          closure.match.T_map_base, graph::square_root_information(closure.match.information)));
    }
    const auto optimise = stage_clock().enter(Stage::kOptimise);
    const backend::BackEndReport added = back_end_->update(std::move(factors), {}, {});
    last_report_ = back_end_->solve();
    num_relinearized_ += added.num_relinearized + last_report_.num_relinearized;
    loop_ids_.insert(loop_ids_.end(), added.new_factor_ids.begin(), added.new_factor_ids.end());
    num_loops_ += static_cast<int>(added.new_factor_ids.size());
    remove_bad_loops();
    const auto& ids = added.new_factor_ids;
    const bool is_any_left = std::any_of(ids.begin(), ids.end(), [&](graph::FactorId id) {
      return back_end_->graph().contains(id);
    });
    if (is_any_left) loop_closer_.on_accepted(path_m_);
    T_map_base_ = estimate().pose(last_key());
  }

  // A closure that still disagrees with the rest after solving was a false one.
  void remove_bad_loops() {
    std::vector<graph::FactorId> bad;
    for (const graph::FactorId id : loop_ids_) {
      if (back_end_->graph().factor(id).chi2(estimate()) > params_.loop_gate) bad.push_back(id);
    }
    if (bad.empty()) return;
    std::erase_if(loop_ids_, [&](graph::FactorId id) {
      return std::find(bad.begin(), bad.end(), id) != bad.end();
    });
    num_removed_loops_ += static_cast<int>(bad.size());
    last_report_ = back_end_->update({}, {}, bad);
    last_report_ = back_end_->solve();
  }

  // Scans between two key scans share the correction of both, in proportion to time.
  Trajectory smoothed_trajectory() const {
    Trajectory trajectory;
    for (const ScanRecord& record : records_) {
      Pose2 T_map_base = estimate().pose(record.key) * record.T_key_base;
      if (record.key < arrivals_.size()) {
        const Timestamp begin = key_scans_[record.key].scan.stamp;
        const Timestamp end = key_scans_[record.key + 1].scan.stamp;
        const double ratio = seconds_between(begin, record.stamp) / seconds_between(begin, end);
        const Pose2 final_step =
            estimate().pose(record.key).between(estimate().pose(record.key + 1));
        const Pose2::Tangent change = (arrivals_[record.key].inverse() * final_step).log();
        T_map_base = T_map_base * Pose2::exp(ratio * change);
      }
      (void)trajectory.append({record.stamp, T_map_base, std::nullopt});
    }
    return trajectory;
  }

  void count_verdict() {
    num_slips_ += verdict_.is_slip ? 1 : 0;
    num_degenerate_ += verdict_.is_degenerate ? 1 : 0;
    num_least_bad_ += verdict_.is_least_bad_kept ? 1 : 0;
  }

  void fill_counters(std::map<std::string, double>& counters) const {
    counters["imu_used"] = has_imu_ ? 1 : 0;
    counters["failed_solves"] = num_failed_solves_;
    counters["key_scans"] = static_cast<double>(key_scans_.size());
    counters["submaps"] = static_cast<double>(local_map_.num_submaps());
    counters["loop_candidates"] = loop_closer_.num_candidates();
    counters["loop_closures"] = num_loops_;
    counters["loop_closures_removed"] = num_removed_loops_;
    counters["slip_intervals"] = num_slips_;
    counters["degenerate_intervals"] = num_degenerate_;
    counters["least_bad_kept"] = num_least_bad_;
    counters["wheel_noise_factor"] = wheel_noise_.factor();
    counters["wheel_scale"] = estimate().wheel_scale(0);
    counters["chi2"] = last_report_.chi2;
    counters["factors"] = static_cast<double>(last_report_.num_factors);
    counters["variables"] = static_cast<double>(last_report_.num_variables);
    counters["relinearised"] = static_cast<double>(num_relinearized_);
  }

  const FusionParams params_;
  const RobotModel robot_;
  std::unique_ptr<backend::BackEnd> back_end_;
  MotionPredictor predictor_;
  LocalMap local_map_;
  LoopCloser loop_closer_;
  WheelNoiseAdapter wheel_noise_;

  bool has_imu_ = false;  // decided at the first scan
  std::vector<KeyScan> key_scans_;
  std::vector<Pose2> arrivals_;  // per key scan: T_key_next as tracked, before solving
  std::vector<ScanRecord> records_;
  Pose2 T_map_base_;
  double path_m_ = 0;
  Timestamp last_scan_stamp_;
  Timestamp anchor_stamp_;  // when wheels or LiDAR last fixed the motion
  bool is_wheel_jump_ = false;
  bool is_velocity_known_ = false;  // wheels or LiDAR measured it at least once
  int num_refused_in_a_row_ = 0;
  IntervalVerdict verdict_;
  std::vector<graph::FactorId> loop_ids_;
  std::set<std::uint32_t> closed_keys_;
  backend::BackEndReport last_report_;
  int num_loops_ = 0, num_removed_loops_ = 0, num_slips_ = 0, num_degenerate_ = 0;
  int num_least_bad_ = 0, num_failed_solves_ = 0;
  std::int64_t num_relinearized_ = 0;
};

}  // namespace

std::unique_ptr<SlamSystem> make_fusion(const FusionParams& params, const RobotModel& robot,
                                        std::unique_ptr<backend::BackEnd> back_end) {
  return std::make_unique<FusionSlam>(params, robot, std::move(back_end));
}

}  // namespace corridor::fusion
