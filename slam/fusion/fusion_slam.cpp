#include "slam/fusion/fusion_slam.hpp"

#include <cmath>
#include <utility>

#include "slam/fusion/calibration.hpp"
#include "slam/fusion/interval_factors.hpp"
#include "slam/fusion/local_map.hpp"
#include "slam/fusion/loop_closer.hpp"
#include "slam/fusion/loop_edges.hpp"
#include "slam/fusion/motion_predictor.hpp"
#include "slam/fusion/run_counters.hpp"
#include "slam/fusion/scan_path.hpp"
#include "slam/fusion/scan_tracker.hpp"
#include "slam/fusion/submap_refiner.hpp"
#include "slam/graph/graph_source.hpp"
#include "slam/motion/deskew.hpp"

namespace corridor::fusion {
namespace {

// A prediction that contradicts this many scans in a row is itself the wrong one.
constexpr int kMaxRefusedInARow = 3;
// A finished submap is through with this before the next one is finished.
constexpr int kRefinedPerKeyScan = 3;

class FusionSlam final : public SlamSystem, public graph::GraphSource {
 public:
  FusionSlam(std::string name, const FusionParams& params, const RobotModel& robot,
             std::unique_ptr<backend::BackEnd> back_end)
      : name_(std::move(name)),
        params_(params),
        robot_(robot),
        back_end_(std::move(back_end)),
        predictor_(robot_, params_),
        local_map_(params_),
        refiner_(robot_, params_),
        loop_closer_(robot_, params_),
        loop_edges_(params_),
        wheel_noise_(params.max_wheel_noise_factor) {}

  std::string_view name() const override { return name_; }
  const graph::FactorGraph& solved_graph() const override { return back_end_->graph(); }
  const graph::Values& solved_values() const override { return back_end_->estimate(); }
  std::vector<Timestamp> pose_stamps() const override {
    std::vector<Timestamp> stamps;
    for (const KeyScan& key_scan : key_scans_) stamps.push_back(key_scan.scan.stamp);
    return stamps;
  }

  Result<StepReport> on_event(const SensorEvent& event) override {
    StepReport report;
    report.stamp = stamp_of(event);
    if (const auto* scan = std::get_if<LaserScan>(&event)) return on_scan(*scan);
    const auto stage = stage_clock().enter(Stage::kPreprocess);
    const auto* wheels = std::get_if<WheelSample>(&event);
    const auto* imu = std::get_if<ImuSample>(&event);
    if (wheels != nullptr && params_.use_wheels) predictor_.add(*wheels);
    if (imu != nullptr && params_.use_imu) predictor_.add(*imu);
    return report;
  }

  Result<SlamEstimate> finish() override {
    SlamEstimate result;
    if (key_scans_.empty()) return result;
    if (is_refining()) {
      refine_submaps(refiner_.rest(key_scans_, local_map_, estimate()));
    }
    {
      const auto stage = stage_clock().enter(Stage::kOptimise);
      keep(back_end_->solve());
    }
    result.trajectory = scan_path_.smoothed(key_scans_, estimate());
    {
      const auto stage = stage_clock().enter(Stage::kMapUpdate);
      std::vector<mapping::PosedScan> scans;
      for (std::uint32_t k = 0; k < key_scans_.size(); ++k) {
        scans.push_back({estimate().pose(k), &key_scans_[k].scan, key_scans_[k].twist_base});
      }
      result.map = mapping::build_occupancy_map(scans, params_.map);
    }
    fill_counters(result.counters);
    return result;
  }

 private:
  const graph::Values& estimate() const { return back_end_->estimate(); }
  // A single scan has nothing to be refined against.
  bool is_refining() const { return params_.use_submaps && params_.use_submap_refinement; }
  std::uint32_t last_key() const { return static_cast<std::uint32_t>(key_scans_.size() - 1); }

  void keep(backend::BackEndReport report) {
    counters_.count(report);
    last_report_ = std::move(report);
  }

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
      const TrackedScan tracked = track(scan.stamp, points, prediction);
      if (is_key_scan(scan.stamp)) {
        add_key_scan(scan, std::move(points), tracked);
        close_loops();
        report.is_key_scan = true;
      }
    }
    scan_path_.add(scan.stamp, last_key(), estimate().pose(last_key()).between(T_map_base_));
    last_scan_stamp_ = scan.stamp;
    if (!is_solved(last_report_)) report.status = StepStatus::kLost;
    report.T_map_base = T_map_base_;
    report.is_slip_detected = verdict_.is_slip;
    report.is_degenerate = verdict_.is_degenerate;
    return report;
  }

  Prediction predict(Timestamp stamp) {
    const auto stage = stage_clock().enter(Stage::kPredict);
    MotionState state;
    state.wheel_noise_factor = wheel_noise_.factor();
    state.twist = twist_;
    if (is_velocity_known_) {
      state.velocity_mps = velocity_base_mps();
      state.velocity_variance_m2ps2 = velocity_variance_m2ps2(
          params_.velocity_sigma_mps, seconds_between(anchor_stamp_, stamp), robot_.imu, params_);
    }
    return predictor_.predict(stamp, state);
  }

  // Of the last key scan, in its own frame.
  Eigen::Vector2d velocity_base_mps() const {
    return estimate().pose(last_key()).rotation().transpose() * estimate().velocity(last_key());
  }

  std::vector<Eigen::Vector2d> preprocess(const LaserScan& scan, const Prediction& prediction) {
    const auto stage = stage_clock().enter(Stage::kPreprocess);
    const double dt = key_scans_.empty() ? 0 : seconds_between(last_scan_stamp_, scan.stamp);
    const Eigen::Vector3d twist =
        dt > 0 ? Eigen::Vector3d(prediction.T_last_now.log() / dt) : Eigen::Vector3d::Zero();
    return motion::deskewed_points(scan, twist, params_.max_range_m);
  }

  void start(const LaserScan& scan, std::vector<Eigen::Vector2d> points) {
    graph::Values values;
    values.set_pose(0, Pose2());
    values.set_wheel_calibration(0, motion::WheelCalibration::Zero());
    std::vector<graph::NewFactor> factors;
    add_first_factors(params_, factors);
    begin_imu_states(0, Eigen::Vector2d::Zero(), values, factors);
    keep(back_end_->update(std::move(factors), values, {}));
    key_scans_.push_back({scan, std::move(points)});
    extend_map();
    begin_interval(scan.stamp);
    anchor_stamp_ = scan.stamp;
  }

  // From the first key scan on that had a reading before it, the IMU has states.
  void begin_imu_states(std::uint32_t key, const Eigen::Vector2d& velocity_map_mps,
                        graph::Values& values, std::vector<graph::NewFactor>& factors) {
    if (has_imu_ || !predictor_.has_reading()) return;
    has_imu_ = true;
    values.set_velocity(key, velocity_map_mps);
    values.set_bias(key, motion::ImuBias::Zero());
    add_imu_priors(key, params_, factors);
  }

  // The calibration changes slowly: now and then it gets a new state.
  void begin_calibration(graph::Values& values, std::vector<graph::NewFactor>& factors) {
    if (!is_wheel_calibration_estimated(params_) || !verdict_.are_wheels_used ||
        path_m_ - calibration_path_m_ < params_.calibration_interval_m) {
      return;
    }
    calibration_path_m_ = path_m_;
    add_next_calibration(calibration_, estimate().wheel_calibration(calibration_), params_, values,
                         factors);
    ++calibration_;
  }

  TrackedScan track(Timestamp stamp, std::span<const Eigen::Vector2d> points,
                    const Prediction& prediction) {
    const auto stage = stage_clock().enter(Stage::kMatch);
    Submap& submap = local_map_.active();
    const Pose2& T_map_submap = estimate().pose(submap.frame());
    TrackedScan tracked = track_scan(submap, points, T_map_submap.between(T_map_base_), prediction,
                                     robot_, params_, num_refused_in_a_row_ < kMaxRefusedInARow);
    num_refused_in_a_row_ = tracked.is_refused ? num_refused_in_a_row_ + 1 : 0;
    const Pose2 T_last_now = T_map_base_.between(T_map_submap * tracked.T_submap_base);
    T_map_base_ = T_map_submap * tracked.T_submap_base;
    path_m_ += T_last_now.translation_m().norm();
    twist_ = T_last_now.log() / seconds_between(last_scan_stamp_, stamp);
    counters_.count_outvoted(tracked.num_outvoted);
    watch_wheels(tracked);
    return tracked;
  }

  void watch_wheels(const TrackedScan& tracked) {
    if (!tracked.wheel_chi2 || tracked.wheel_degrees_of_freedom == 0) return;
    if (tracked.match->num_observable == 3 && *tracked.wheel_chi2 > params_.slip_gate) {
      is_wheel_jump_ = true;
    }
    if (params_.use_directional_degeneracy) {
      wheel_noise_.observe(*tracked.wheel_chi2 / tracked.wheel_degrees_of_freedom);
    }
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
    interval.tracked_T_i_j = estimate().pose(interval.i).between(T_map_base_);
    if (has_imu_) {
      interval.imu = predictor_.imu_interval();
      interval.velocity_base_i_mps = velocity_base_mps();
    }
    interval.match = tracked.match;
    interval.submap_frame = local_map_.active().frame();
    interval.is_wheel_jump = is_wheel_jump_;
    interval.range_difference_m =
        mean_range_difference_m(key_scans_.back().scan, scan, interval.tracked_T_i_j.theta_rad());
    interval.wheels = predictor_.wheel_interval();
    interval.calibration = calibration_;
    interval.wheel_calibration = estimate().wheel_calibration(calibration_);
    interval.velocity_sigma_mps =
        is_velocity_known_ ? params_.velocity_sigma_mps : params_.initial_velocity_sigma_mps;
    interval.anchor_age_s = seconds_between(anchor_stamp_, scan.stamp);
    return interval;
  }

  void add_key_scan(const LaserScan& scan, std::vector<Eigen::Vector2d> points,
                    const TrackedScan& tracked) {
    Submap& matched = local_map_.active();
    {
      const auto stage = stage_clock().enter(Stage::kGraph);
      const Interval interval = interval_to(scan, tracked);
      is_velocity_known_ = is_velocity_known_ || interval.imu.has_value();
      std::vector<graph::NewFactor> factors;
      verdict_ = add_interval_factors(interval, robot_, wheel_noise_.factor(), params_, factors);
      counters_.count(verdict_);
      scan_path_.add_arrival(interval.tracked_T_i_j);
      graph::Values values = initial_values(interval);
      begin_calibration(values, factors);
      begin_imu_states(interval.j, T_map_base_.rotation() * twist_.head<2>(), values, factors);
      const auto optimise = stage_clock().enter(Stage::kOptimise);
      keep(back_end_->update(std::move(factors), values, {}));
    }
    if (verdict_.are_wheels_used || !verdict_.is_degenerate) anchor_stamp_ = scan.stamp;
    key_scans_.push_back(
        {scan, std::move(points), tracked.match && tracked.num_outvoted == 0, path_m_, twist_});
    T_map_base_ = estimate().pose(last_key());
    extend_map();
    if (is_refining()) {
      if (verdict_.lidar_factor) {
        matched.set_factor(last_key(), last_report_.new_factor_ids[*verdict_.lidar_factor],
                           tracked.match->num_observable);
      }
      refine_submaps(refiner_.next(kRefinedPerKeyScan, key_scans_, local_map_, estimate()));
      T_map_base_ = estimate().pose(last_key());
    }
    release_submaps();
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
    Submap* started = local_map_.insert(last_key(), estimate(), key_scans_.back().points_base_m);
    if (started == nullptr || !params_.use_submaps) return;
    graph::Values frame;
    frame.set_pose(started->frame(), estimate().pose(last_key()));
    const auto ids =
        back_end_->add({frame_factor(*started, key_scans_.back(), robot_, params_)}, frame);
    if (is_refining()) started->set_factor(last_key(), ids.front(), 0);
  }

  void refine_submaps(std::vector<RefinedPlace> places) {
    if (places.empty()) return;
    std::vector<graph::NewFactor> factors;
    std::vector<graph::FactorId> replaced;
    for (RefinedPlace& place : places) {
      factors.push_back(std::move(place.factor));
      if (place.replaced) replaced.push_back(*place.replaced);
    }
    const auto stage = stage_clock().enter(Stage::kOptimise);
    keep(back_end_->update(std::move(factors), {}, replaced));
  }

  // Finished submaps wait for their refinement, and with loop closing for a return.
  void release_submaps() {
    if (params_.use_loop_closing) return;
    local_map_.release(is_refining() ? refiner_.num_done() : local_map_.finished().size());
  }

  void begin_interval(Timestamp stamp) {
    is_wheel_jump_ = false;
    predictor_.reset_interval(
        stamp, has_imu_ ? estimate().bias(last_key()) : motion::ImuBias(motion::ImuBias::Zero()),
        estimate().wheel_calibration(calibration_));
  }

  void close_loops() {
    if (!params_.use_loop_closing) return;
    const auto stage = stage_clock().enter(Stage::kLoopSearch);
    const std::vector<LoopClosure> closures =
        loop_closer_.search(key_scans_, local_map_, estimate());
    if (closures.empty()) return;
    const auto optimise = stage_clock().enter(Stage::kOptimise);
    for (backend::BackEndReport& report : loop_edges_.add(closures, *back_end_)) {
      keep(std::move(report));
    }
    loop_closer_.set_last_closure(loop_edges_.last_path_m());
    T_map_base_ = estimate().pose(last_key());
  }

  void fill_counters(std::map<std::string, double>& counters) const {
    counters_.write(counters);
    write_calibration(estimate(), calibration_, last_key(), has_imu_, counters);
    counters["imu_used"] = has_imu_ ? 1 : 0;
    counters["key_scans"] = static_cast<double>(key_scans_.size());
    counters["submaps"] = static_cast<double>(local_map_.num_submaps());
    counters["loop_candidates"] = loop_closer_.num_candidates();
    counters["loop_closures"] = static_cast<double>(loop_edges_.num_in_graph());
    counters["loop_closures_removed"] = loop_edges_.num_removed();
    counters["wheel_noise_factor"] = wheel_noise_.factor();
  }

  const std::string name_;
  const FusionParams params_;
  const RobotModel robot_;
  std::unique_ptr<backend::BackEnd> back_end_;
  MotionPredictor predictor_;
  LocalMap local_map_;
  SubmapRefiner refiner_;
  LoopCloser loop_closer_;
  LoopEdges loop_edges_;
  ScanPath scan_path_;
  WheelNoiseAdapter wheel_noise_;

  std::uint32_t calibration_ = 0;  // number of the wheels' present calibration
  double calibration_path_m_ = 0;  // where it began
  bool has_imu_ = false;           // the last key scan has states of the IMU
  std::vector<KeyScan> key_scans_;
  Pose2 T_map_base_;
  Eigen::Vector3d twist_ = Eigen::Vector3d::Zero();  // between the last two scans, per second
  double path_m_ = 0;
  Timestamp last_scan_stamp_;
  Timestamp anchor_stamp_;  // when wheels or LiDAR last fixed the motion
  bool is_wheel_jump_ = false;
  bool is_velocity_known_ = false;  // an interval with IMU has been solved
  int num_refused_in_a_row_ = 0;
  IntervalVerdict verdict_;
  backend::BackEndReport last_report_;
  RunCounters counters_;
};

}  // namespace

std::unique_ptr<SlamSystem> make_fusion(std::string name, const FusionParams& params,
                                        const RobotModel& robot,
                                        std::unique_ptr<backend::BackEnd> back_end) {
  return std::make_unique<FusionSlam>(std::move(name), params, robot, std::move(back_end));
}

}  // namespace corridor::fusion
