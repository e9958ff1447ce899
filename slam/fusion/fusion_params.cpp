#include "slam/fusion/fusion_params.hpp"

namespace corridor::fusion {

std::vector<std::string> FusionParams::relations() const {
  std::vector<std::string> broken;
  if (coarse_resolution_m <= fine_resolution_m) {
    broken.push_back(
        fmt::format("coarse_resolution_m = {}: expected more than fine_resolution_m = {}",
                    coarse_resolution_m, fine_resolution_m));
  }
  const auto expect_no_more = [&](const char* name, double value, const char* limit_name,
                                  double limit) {
    if (value <= limit) return;
    broken.push_back(
        fmt::format("{} = {}: expected no more than {} = {}", name, value, limit_name, limit));
  };
  expect_no_more("match_prior_sigma_m", match_prior_sigma_m, "retry_prior_sigma_m",
                 retry_prior_sigma_m);
  expect_no_more("match_prior_sigma_rad", match_prior_sigma_rad, "retry_prior_sigma_rad",
                 retry_prior_sigma_rad);
  return broken;
}

FusionParams fusion_paper_params() {
  FusionParams params;
  params.key_distance_m = 0.2;
  params.key_angle_rad = 0.17;
  params.use_directional_degeneracy = false;
  params.use_statistical_slip_test = false;
  params.use_submaps = false;
  params.use_submap_refinement = false;
  params.use_wheel_scale = false;
  params.use_wheel_turn = false;
  params.use_wheel_delay = false;
  params.use_axle_pose = false;
  params.use_gyro_scale = false;
  params.use_majority_vote = false;
  params.use_loop_closing = false;
  params.hold_unseen_passes = 0;
  return params;
}

FusionParams fusion_paper_with_directions() {
  FusionParams params = fusion_paper_params();
  params.use_directional_degeneracy = true;
  return params;
}

}  // namespace corridor::fusion
