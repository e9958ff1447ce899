#include "slam/fusion/ablations.hpp"

#include <functional>

namespace corridor::fusion {

std::vector<Ablation> ablations() {
  std::vector<Ablation> all;
  const auto without = [&](const char* part, const char* description,
                           const std::function<void(FusionParams&)>& leave_out) {
    FusionParams params;
    leave_out(params);
    all.push_back({std::string("without-") + part, description, params});
  };
  using P = FusionParams;
  without("directions", "the LiDAR in or out as a whole, by the paper's test",
          [](P& p) { p.use_directional_degeneracy = false; });
  without("slip-statistics", "slip by the paper's fixed threshold",
          [](P& p) { p.use_statistical_slip_test = false; });
  without("submaps", "scans matched against the last key scan", [](P& p) {
    p.use_submaps = false;
    p.use_submap_refinement = false;
  });
  without("refinement", "no second match against the finished submap",
          [](P& p) { p.use_submap_refinement = false; });
  without("holding", "matches not held at the prediction along what they do not see",
          [](P& p) { p.hold_unseen_passes = 0; });
  without("vote", "the LiDAR is believed against wheels and IMU",
          [](P& p) { p.use_majority_vote = false; });
  without("loops", "no loop closing", [](P& p) { p.use_loop_closing = false; });
  without("calibration", "nothing calibrated on the way", [](P& p) {
    p.use_wheel_scale = p.use_wheel_turn = p.use_wheel_delay = false;
    p.use_axle_pose = p.use_gyro_scale = false;
  });
  without("wheel-scale", "the wheels' scale as given", [](P& p) { p.use_wheel_scale = false; });
  without("wheel-turn", "the wheels' balance and track as given",
          [](P& p) { p.use_wheel_turn = false; });
  without("wheel-delay", "the wheels' clock as given", [](P& p) { p.use_wheel_delay = false; });
  without("axle-pose", "the LiDAR's place over the axle as given",
          [](P& p) { p.use_axle_pose = false; });
  without("gyro-scale", "the gyro's scale as given", [](P& p) { p.use_gyro_scale = false; });
  without("imu", "LiDAR and wheels alone", [](P& p) { p.use_imu = false; });
  without("wheels", "LiDAR and IMU alone", [](P& p) { p.use_wheels = false; });
  without("imu-and-wheels", "LiDAR alone", [](P& p) { p.use_imu = p.use_wheels = false; });
  return all;
}

}  // namespace corridor::fusion
