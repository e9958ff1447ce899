#include "baselines/mrpt/mrpt_rbpf.hpp"

#include <fmt/format.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CICP.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include <deque>
#include <exception>
#include <optional>
#include <stdexcept>
#include <vector>

#include "baselines/mrpt/conversions.hpp"
#include "slam/core/expect.hpp"
#include "slam/motion/dense_path.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::mrpt {
namespace {

using Builder = ::mrpt::slam::CMetricMapBuilderRBPF;

::mrpt::maps::COccupancyGridMap2D::TMapDefinition grid_definition(const MrptRbpfParams& params) {
  ::mrpt::maps::COccupancyGridMap2D::TMapDefinition grid;
  grid.resolution = static_cast<float>(params.cell_size_m);
  grid.insertionOpts.maxDistanceInsertion = static_cast<float>(params.insertion_range_m);
  grid.insertionOpts.maxOccupancyUpdateCertainty =
      static_cast<float>(params.max_occupancy_certainty);
  grid.insertionOpts.considerInvalidRangesAsFreeSpace = params.use_no_returns;
  auto& likelihood = grid.likelihoodOpts;
  likelihood.likelihoodMethod = ::mrpt::maps::COccupancyGridMap2D::lmLikelihoodField_Thrun;
  likelihood.LF_decimation = static_cast<unsigned>(params.likelihood_decimation);
  likelihood.LF_stdHit = static_cast<float>(params.likelihood_sigma_m);
  likelihood.LF_maxCorrsDistance = static_cast<float>(params.likelihood_max_distance_m);
  likelihood.LF_zHit = static_cast<float>(params.likelihood_hit_weight);
  likelihood.LF_zRandom = static_cast<float>(params.likelihood_random_weight);
  likelihood.LF_maxRange = static_cast<float>(params.likelihood_range_m);
  likelihood.LF_alternateAverageMethod = false;
  likelihood.enableLikelihoodCache = true;
  return grid;
}

::mrpt::maps::CSimplePointsMap::TMapDefinition points_definition(const MrptRbpfParams& params) {
  ::mrpt::maps::CSimplePointsMap::TMapDefinition points;
  points.insertionOpts.minDistBetweenLaserPoints = static_cast<float>(params.min_point_distance_m);
  points.insertionOpts.fuseWithExisting = false;
  points.insertionOpts.isPlanarMap = true;
  points.likelihoodOpts.sigma_dist = params.points_sigma_m;
  points.likelihoodOpts.max_corr_distance = params.points_max_distance_m;
  points.likelihoodOpts.decimation = static_cast<unsigned>(params.points_decimation);
  return points;
}

Builder::TConstructionOptions construction_options(const MrptRbpfParams& params) {
  Builder::TConstructionOptions options;
  options.verbosity_level = ::mrpt::system::LVL_ERROR;
  options.localizeLinDistance = static_cast<float>(params.localization_linear_m);
  options.localizeAngDistance = static_cast<float>(params.localization_angular_rad);
  options.insertionLinDistance = static_cast<float>(params.insertion_linear_m);
  options.insertionAngDistance = static_cast<float>(params.insertion_angular_rad);
  auto& filter = options.PF_options;
  filter.PF_algorithm = params.use_icp_proposal
                            ? ::mrpt::bayes::CParticleFilter::pfOptimalProposal
                            : ::mrpt::bayes::CParticleFilter::pfAuxiliaryPFOptimal;
  filter.resamplingMethod = ::mrpt::bayes::CParticleFilter::prMultinomial;
  filter.adaptiveSampleSize = false;
  filter.sampleSize = static_cast<unsigned>(params.num_particles);
  filter.BETA = params.resample_threshold_ratio;
  filter.powFactor = params.likelihood_power;
  filter.pfAuxFilterOptimal_MaximumSearchSamples = static_cast<unsigned>(params.num_search_samples);
  if (params.use_icp_proposal) {
    constexpr int kMatchAgainstPoints = 3;
    options.mapsInitializers.push_back(points_definition(params));
    options.predictionOptions.pfOptimalProposal_mapSelection = kMatchAgainstPoints;
    options.predictionOptions.ICPGlobalAlign_MinQuality = static_cast<float>(params.min_goodness);
    options.predictionOptions.icp_params = to_mrpt(params.icp).options;
  } else {
    options.mapsInitializers.push_back(grid_definition(params));
  }
  return options;
}

class MrptRbpf final : public SlamSystem {
 public:
  MrptRbpf(const MrptRbpfParams& params, const RobotModel& robot, Rng rng)
      : map_cell_size_m_(params.cell_size_m),
        range_sigma_m_(robot.lidar.range_sigma_m),
        rng_(rng.stream("mrpt-rbpf")),
        builder_(construction_options(params)) {
    CORRIDOR_EXPECT(param_violations(params).empty());
    builder_.mapPDF.setMinLoggingLevel(::mrpt::system::LVL_ERROR);
  }

  [[nodiscard]] std::string_view name() const override { return "mrpt-rbpf"; }

  Result<StepReport> on_event(const SensorEvent& event) override {
    StepReport report;
    report.stamp = stamp_of(event);
    if (const auto* wheel = std::get_if<WheelSample>(&event)) wheel_track_.add(*wheel);
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) return report;
    try {
      on_scan(*scan, report);
    } catch (const std::exception& error) {
      return fail(ErrorCode::kInternal, fmt::format("MRPT's RBPF-SLAM failed: {}", error.what()),
                  fmt::format("scan {}", records_.size()));
    }
    return report;
  }

  Result<SlamEstimate> finish() override {
    const auto scope = stage_clock().enter(Stage::kFinish);
    SlamEstimate estimate;
    if (records_.empty()) {
      estimate.map = GridMap();
      return estimate;
    }
    try {
      estimate.trajectory = motion::dense_path(records_, key_poses());
      estimate.map = current_map();
    } catch (const std::exception& error) {
      return fail(ErrorCode::kInternal,
                  fmt::format("MRPT could not give its estimate: {}", error.what()));
    }
    estimate.counters = {{"key_scans", static_cast<double>(path_indices_.size())}};
    return estimate;
  }

 private:
  void on_scan(const LaserScan& scan, StepReport& report) {
    const auto scope = stage_clock().enter(Stage::kMatch);
    // A new generator, because randomize() would leave a spare normal number of the last one in it.
    ::mrpt::random::getRandomGenerator() =
        ::mrpt::random::CRandomGenerator(rng_.stream(records_.size()).next_u32());
    const Pose2 T_last_now = odometry_step(scan.stamp);
    ::mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(to_mrpt(T_last_now), {});
    ::mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    ::mrpt::obs::CSensoryFrame observations;
    observations.insert(to_mrpt(scan, range_sigma_m_));
    builder_.processActionObservation(actions, observations);
    const bool is_key = note_path_length();
    records_.push_back({scan.stamp, T_start_base_, is_key});
    report.status = StepStatus::kTracked;
    report.is_key_scan = is_key;
    report.T_map_base =
        to_pose2(::mrpt::poses::CPose3D(builder_.getCurrentPoseEstimation()->getMeanVal()));
    if (!report.T_map_base->is_finite()) {
      throw std::runtime_error("the estimated pose is not finite");
    }
  }

  // Motion of the base since the last scan; none without wheel odometry.
  Pose2 odometry_step(Timestamp stamp) {
    const std::optional<Pose2> T_odom_base = wheel_track_.pose_at(stamp);
    if (!T_odom_base) return {};
    const Pose2 T_last_now = last_T_odom_base_ ? last_T_odom_base_->between(*T_odom_base) : Pose2();
    last_T_odom_base_ = T_odom_base;
    T_start_base_ = T_start_base_ * T_last_now;
    return T_last_now;
  }

  // True if the filter ran: the particles' paths have grown, or this is the first scan.
  bool note_path_length() {
    const std::size_t length = builder_.mapPDF.m_particles.front().d->robotPath.size();
    if (!path_indices_.empty() && path_indices_.back() + 1 == length) return false;
    path_indices_.push_back(length - 1);
    return true;
  }

  [[nodiscard]] std::vector<Pose2> key_poses() const {
    std::deque<::mrpt::math::TPose3D> path;
    builder_.getCurrentMostLikelyPath(path);
    std::vector<Pose2> poses;
    for (const std::size_t index : path_indices_) {
      poses.emplace_back(path.at(index).x, path.at(index).y, path.at(index).yaw);
    }
    return poses;
  }

  // The most likely particle's grid; with maps of points MRPT's grid of the scans in them, each at
  // the particles' mean.
  [[nodiscard]] GridMap current_map() const {
    const auto* maps = builder_.getCurrentlyBuiltMetricMap();
    if (maps->countMapsByClass<::mrpt::maps::COccupancyGridMap2D>() > 0) {
      return to_grid_map(*maps->mapByClass<::mrpt::maps::COccupancyGridMap2D>(0));
    }
    ::mrpt::maps::CSimpleMap key_scans;
    builder_.getCurrentlyBuiltMap(key_scans);
    return to_grid_map(key_scans, map_cell_size_m_);
  }

  double map_cell_size_m_;
  double range_sigma_m_;
  Rng rng_;
  Builder builder_;
  motion::WheelTrack wheel_track_;
  std::optional<Pose2> last_T_odom_base_;    // at the last scan
  Pose2 T_start_base_;                       // odometry since the first scan
  std::vector<motion::ScanRecord> records_;  // one per scan
  std::vector<std::size_t> path_indices_;    // of the particles' paths, one per key scan
};

}  // namespace

MrptRbpfParams icp_rbpf_params() {
  MrptRbpfParams params;
  params.use_icp_proposal = true;
  params.num_particles = 10;
  params.localization_linear_m = 0.2;
  params.localization_angular_rad = 0.17453292519943295;  // 10 deg
  params.insertion_linear_m = 2;
  params.insertion_angular_rad = 0.5235987755982988;  // 30 deg
  params.likelihood_power = 1;
  params.min_goodness = 0.80;
  params.icp.use_levenberg_marquardt = true;
  params.icp.max_iterations = 60;
  params.icp.threshold_m = 1;
  params.icp.threshold_shrink_ratio = 0.5;
  params.icp.smallest_threshold_m = 0.1;
  params.icp.use_unique_robust = false;
  return params;
}

MrptRbpfParams dense_rbpf_params() {
  MrptRbpfParams params = icp_rbpf_params();
  params.localization_angular_rad = 0.1;
  params.insertion_linear_m = 1;
  params.insertion_angular_rad = 0.35;
  params.min_goodness = 0.4;
  params.icp = IcpParams();
  params.icp.max_iterations = 60;
  params.icp.point_decimation = 1;
  return params;
}

std::unique_ptr<SlamSystem> make_mrpt_rbpf(const MrptRbpfParams& params, const RobotModel& robot,
                                           Rng rng) {
  return std::make_unique<MrptRbpf>(params, robot, rng);
}

}  // namespace corridor::mrpt
