#include "baselines/karto/karto_params.hpp"

namespace corridor::karto {

KartoParams corrected_params() {
  KartoParams params;
  params.count_no_returns = false;
  params.wrap_rows = false;
  params.use_plain_mean_heading = false;
  return params;
}

KartoParams slam_toolbox_params() {
  KartoParams params;
  params.min_travel_distance_m = 0.5;
  params.min_travel_heading_rad = 0.5;
  params.min_time_interval_s = 0.5;
  params.buffer_size_scans = 10;
  params.buffer_max_distance_m = 10;
  params.range_threshold_m = 20;
  params.link_max_distance_m = 1.5;
  params.link_min_response = 0.1;
  params.loop_max_distance_m = 3;
  params.loop_max_variance_coarse_m2 = 9;
  params.loop_min_response_coarse = 0.35;
  params.loop_min_response_fine = 0.45;
  params.match_window_m = 0.5;
  params.match_smear_m = 0.1;
  params.distance_variance_penalty_m2 = 0.25;
  params.angle_variance_penalty_rad2 = 1;
  params.use_response_expansion = true;
  return params;
}

}  // namespace corridor::karto
