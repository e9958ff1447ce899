#include "baselines/mrpt/mrpt_icp.hpp"

#include <fmt/format.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/slam/CICP.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include <exception>
#include <optional>
#include <stdexcept>

#include "baselines/mrpt/conversions.hpp"
#include "slam/core/expect.hpp"

namespace corridor::mrpt {
namespace {

using Builder = ::mrpt::slam::CMetricMapBuilderICP;

void configure(Builder& builder, const MrptIcpParams& params) {
  builder.setVerbosityLevel(::mrpt::system::LVL_ERROR);
  builder.ICP_params = to_mrpt(params.icp).options;
  auto& options = builder.ICP_options;
  options.matchAgainstTheGrid = false;
  options.localizationLinDistance = params.localization_linear_m;
  options.localizationAngDistance = params.localization_angular_rad;
  options.insertionLinDistance = params.insertion_linear_m;
  options.insertionAngDistance = params.insertion_angular_rad;
  options.minICPgoodnessToAccept = params.min_goodness;
  ::mrpt::maps::CSimplePointsMap::TMapDefinition points;
  points.insertionOpts.minDistBetweenLaserPoints = static_cast<float>(params.min_point_distance_m);
  points.insertionOpts.fuseWithExisting = false;
  points.insertionOpts.isPlanarMap = true;
  options.mapInitializers.push_back(points);
  builder.initialize();
}

class MrptIcp final : public SlamSystem {
 public:
  MrptIcp(const MrptIcpParams& params, const RobotModel& robot)
      : map_cell_size_m_(params.map_cell_size_m), range_sigma_m_(robot.lidar.range_sigma_m) {
    CORRIDOR_EXPECT(param_violations(params).empty());
    configure(builder_, params);
  }

  [[nodiscard]] std::string_view name() const override { return "mrpt-icp"; }

  Result<StepReport> on_event(const SensorEvent& event) override {
    StepReport report;
    report.stamp = stamp_of(event);
    try {
      if (const auto* wheel = std::get_if<WheelSample>(&event)) on_wheels(*wheel);
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) return report;
      on_scan(*scan, report);
    } catch (const std::exception& error) {
      return fail(ErrorCode::kInternal, fmt::format("MRPT's ICP-SLAM failed: {}", error.what()),
                  fmt::format("scan {}", path_.size()));
    }
    return report;
  }

  Result<SlamEstimate> finish() override {
    const auto scope = stage_clock().enter(Stage::kFinish);
    SlamEstimate estimate;
    estimate.trajectory = path_;
    estimate.counters = {{"key_scans", static_cast<double>(builder_.getCurrentlyBuiltMapSize())}};
    try {
      ::mrpt::maps::CSimpleMap key_scans;
      builder_.getCurrentlyBuiltMap(key_scans);
      estimate.map = to_grid_map(key_scans, map_cell_size_m_);  // MRPT's, of the scans it inserted
    } catch (const std::exception& error) {
      return fail(ErrorCode::kInternal,
                  fmt::format("MRPT could not build the map: {}", error.what()));
    }
    return estimate;
  }

 private:
  // Odometry counts from the first scan, so that the map begins where the robot does.
  void on_wheels(const WheelSample& wheel) {
    const auto scope = stage_clock().enter(Stage::kPredict);
    if (!T_odom_first_ || path_.empty()) T_odom_first_ = wheel.T_odom_base;
    if (path_.empty()) return;
    builder_.processObservation(to_mrpt(wheel.stamp, T_odom_first_->between(wheel.T_odom_base)));
  }

  void on_scan(const LaserScan& scan, StepReport& report) {
    const auto scope = stage_clock().enter(Stage::kMatch);
    const unsigned num_before = builder_.getCurrentlyBuiltMapSize();
    if (path_.empty() && T_odom_first_) builder_.processObservation(to_mrpt(scan.stamp, Pose2()));
    builder_.processObservation(to_mrpt(scan, range_sigma_m_));
    report.status = StepStatus::kTracked;
    report.T_map_base =
        to_pose2(::mrpt::poses::CPose3D(builder_.getCurrentPoseEstimation()->getMeanVal()));
    report.is_key_scan = builder_.getCurrentlyBuiltMapSize() > num_before;
    if (!path_.append({scan.stamp, *report.T_map_base, std::nullopt})) {
      throw std::runtime_error("the estimated pose is not finite");
    }
  }

  double map_cell_size_m_;
  double range_sigma_m_;
  Builder builder_;
  std::optional<Pose2> T_odom_first_;
  Trajectory path_;
};

}  // namespace

MrptIcpParams dense_icp_params() {
  MrptIcpParams params;
  params.localization_linear_m = 0.05;
  params.localization_angular_rad = 0.035;
  params.insertion_linear_m = 0.3;
  params.insertion_angular_rad = 0.17;
  params.icp.point_decimation = 1;
  return params;
}

std::unique_ptr<SlamSystem> make_mrpt_icp(const MrptIcpParams& params, const RobotModel& robot) {
  return std::make_unique<MrptIcp>(params, robot);
}

}  // namespace corridor::mrpt
