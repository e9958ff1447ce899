// Parameters of the Karto-style baseline; the defaults are the values the original ships with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/core/params.hpp"

namespace corridor::karto {

struct KartoParams {
  // Key scans and the running buffer.
  bool use_gyro_odometry = false;
  double min_travel_distance_m = 0.2;
  double min_travel_heading_rad = 0.174;  // 10 deg, rounded as shipped
  double min_time_interval_s = 3600;
  int buffer_size_scans = 70;
  double buffer_max_distance_m = 20;
  bool use_barycentre = true;
  double range_threshold_m = 0;

  // Links and loop closing.
  double link_max_distance_m = 10;
  double link_min_response = 0.8;
  bool use_loop_closing = true;
  double loop_max_distance_m = 4;
  int loop_min_chain_scans = 10;
  double loop_max_variance_coarse_m2 = 0.16;
  double loop_min_response_coarse = 0.8;
  double loop_min_response_fine = 0.8;

  // Correlation grids.
  double match_window_m = 0.3;
  double match_resolution_m = 0.01;
  double match_smear_m = 0.03;
  double loop_window_m = 8.0;
  double loop_resolution_m = 0.05;
  double loop_smear_m = 0.03;

  // Search and penalty.
  double distance_variance_penalty_m2 = 0.09;
  double angle_variance_penalty_rad2 = 0.12184696791468343;  // (20 deg)^2
  double min_distance_penalty = 0.5;
  double min_angle_penalty = 0.9;
  double coarse_angle_offset_rad = 0.349;       // 20 deg, rounded as shipped
  double coarse_angle_resolution_rad = 0.0349;  // 2 deg, rounded as shipped
  double fine_angle_resolution_rad = 0.00349;   // 0.2 deg, rounded as shipped
  bool use_response_expansion = false;

  // The published map.
  double map_resolution_m = 0.05;
  int map_min_passes = 2;
  double map_occupancy_threshold = 0.1;

  // Switches of the `corrected` profile: true is what the original ships.
  bool count_no_returns = true;
  bool wrap_rows = true;
  bool use_plain_mean_heading = true;

  template <class V>
  static void visit(KartoParams& p, V&& v) {
    visit_key_scans(p, v);
    visit_links(p, v);
    visit_grids(p, v);
    visit_search(p, v);
    visit_map_and_switches(p, v);
  }

  // Rules across fields.
  [[nodiscard]] std::vector<std::string> relations() const {
    std::vector<std::string> broken;
    check_smear("match_smear_m", match_smear_m, match_resolution_m, broken);
    check_smear("loop_smear_m", loop_smear_m, loop_resolution_m, broken);
    check_grid("match_resolution_m", match_resolution_m, match_window_m, broken);
    check_grid("loop_resolution_m", loop_resolution_m, loop_window_m, broken);
    return broken;
  }

 private:
  template <class V>
  static void visit_key_scans(KartoParams& p, V& v) {
    v(ParamInfo{"use_gyro_odometry", "",
                "turns of the odometry from an EKF of wheels and gyro; the original has no gyro"},
      p.use_gyro_odometry);
    v(ParamInfo{"min_travel_distance_m", "m",
                "odometry distance since the last key scan that makes a new one", 0, 100},
      p.min_travel_distance_m);
    v(ParamInfo{"min_travel_heading_rad", "rad",
                "odometry turn since the last key scan that makes a new one", 0, 3.2},
      p.min_travel_heading_rad);
    v(ParamInfo{"min_time_interval_s", "s", "time since the last key scan that makes a new one", 0},
      p.min_time_interval_s);
    v(ParamInfo{"buffer_size_scans", "1",
                "key scans in the running buffer, the local map of sequential matching", 1, 100000},
      p.buffer_size_scans);
    v(ParamInfo{"buffer_max_distance_m", "m",
                "largest distance between the first and last scan of the running buffer", 0},
      p.buffer_max_distance_m);
    v(ParamInfo{"use_barycentre", "",
                "distances between scans are those of their mean end points, not of the sensor"},
      p.use_barycentre);
    v(ParamInfo{"range_threshold_m", "m",
                "longer ranges count as no return; sizes the grids; 0 = the sensor's limit, at "
                "most 12 m",
                0, 1000},
      p.range_threshold_m);
  }

  template <class V>
  static void visit_links(KartoParams& p, V& v) {
    v(ParamInfo{"link_max_distance_m", "m", "radius of near chains and longest link", 0},
      p.link_max_distance_m);
    v(ParamInfo{"link_min_response", "1", "a near chain is linked above this response", 0, 1},
      p.link_min_response);
    v(ParamInfo{"use_loop_closing", "", "search for loops and optimise when one is found"},
      p.use_loop_closing);
    v(ParamInfo{"loop_max_distance_m", "m", "radius of loop candidates", 0}, p.loop_max_distance_m);
    v(ParamInfo{"loop_min_chain_scans", "1",
                "consecutive scans a loop candidate or near chain needs", 1, 100000},
      p.loop_min_chain_scans);
    v(ParamInfo{"loop_max_variance_coarse_m2", "m^2",
                "coarse loop match accepted below this variance in x and y", 0},
      p.loop_max_variance_coarse_m2);
    v(ParamInfo{"loop_min_response_coarse", "1", "coarse loop match accepted above this response",
                0, 1},
      p.loop_min_response_coarse);
    v(ParamInfo{"loop_min_response_fine", "1", "fine loop match accepted from this response on", 0,
                1},
      p.loop_min_response_fine);
  }

  template <class V>
  static void visit_grids(KartoParams& p, V& v) {
    v(ParamInfo{"match_window_m", "m", "side of the sequential matcher's search window", 0.001,
                100},
      p.match_window_m);
    v(ParamInfo{"match_resolution_m", "m", "cell of the sequential matcher's grid", 0.001, 1},
      p.match_resolution_m);
    v(ParamInfo{"match_smear_m", "m",
                "standard deviation of an end point in that grid; 0.5 to 10 cells", 0.0005, 10},
      p.match_smear_m);
    v(ParamInfo{"loop_window_m", "m", "side of the loop matcher's search window", 0.001, 100},
      p.loop_window_m);
    v(ParamInfo{"loop_resolution_m", "m", "cell of the loop matcher's grid", 0.001, 1},
      p.loop_resolution_m);
    v(ParamInfo{"loop_smear_m", "m",
                "standard deviation of an end point in that grid; 0.5 to 10 cells", 0.0005, 10},
      p.loop_smear_m);
  }

  template <class V>
  static void visit_search(KartoParams& p, V& v) {
    v(ParamInfo{"distance_variance_penalty_m2", "m^2",
                "variance of the penalty on distance from the prediction", 1e-9},
      p.distance_variance_penalty_m2);
    v(ParamInfo{"angle_variance_penalty_rad2", "rad^2",
                "variance of the penalty on rotation from the prediction", 1e-9},
      p.angle_variance_penalty_rad2);
    v(ParamInfo{"min_distance_penalty", "1", "floor of the distance penalty", 0, 1},
      p.min_distance_penalty);
    v(ParamInfo{"min_angle_penalty", "1", "floor of the angle penalty", 0, 1}, p.min_angle_penalty);
    v(ParamInfo{"coarse_angle_offset_rad", "rad", "half width of the coarse search in heading", 0,
                3.2},
      p.coarse_angle_offset_rad);
    v(
        ParamInfo{
            "coarse_angle_resolution_rad", "rad",
            "step of the coarse search in heading; the fine search spans half of it to each side",
            1e-5, 1},
        p.coarse_angle_resolution_rad);
    v(ParamInfo{"fine_angle_resolution_rad", "rad", "step of the fine search in heading", 1e-5, 1},
      p.fine_angle_resolution_rad);
    v(ParamInfo{"use_response_expansion", "",
                "widen a coarse search that found nothing to 40, 60, 80 deg"},
      p.use_response_expansion);
  }

  template <class V>
  static void visit_map_and_switches(KartoParams& p, V& v) {
    v(ParamInfo{"map_resolution_m", "m", "cell of the published map", 0.005, 1},
      p.map_resolution_m);
    v(ParamInfo{"map_min_passes", "1", "a cell is known when more beams passed or ended in it", 0,
                1000},
      p.map_min_passes);
    v(ParamInfo{"map_occupancy_threshold", "1", "occupied above this share of beams that ended",
                0.001, 0.999},
      p.map_occupancy_threshold);
    v(ParamInfo{"count_no_returns", "",
                "beams without return lower the response and stand at their raw range; false: left "
                "out"},
      p.count_no_returns);
    v(ParamInfo{"wrap_rows", "",
                "beams leaving the grid sideways read another row; false: read nothing"},
      p.wrap_rows);
    v(ParamInfo{"use_plain_mean_heading", "",
                "headings of several matches are averaged unweighted; false: by their information"},
      p.use_plain_mean_heading);
  }

  static void check_smear(std::string_view name, double smear_m, double resolution_m,
                          std::vector<std::string>& broken) {
    constexpr double kMinCells = 0.5;
    constexpr double kMaxCells = 10;
    if (smear_m >= kMinCells * resolution_m && smear_m <= kMaxCells * resolution_m) return;
    broken.push_back(fmt::format("{} = {}: expected {} to {} times the resolution {} m", name,
                                 smear_m, kMinCells, kMaxCells, resolution_m));
  }

  // One byte a cell, and linear indices of 32 bits.
  void check_grid(std::string_view name, double resolution_m, double window_m,
                  std::vector<std::string>& broken) const {
    constexpr double kMaxHalfSide_cells = 12000;
    constexpr double kLongestDefaultRange_m = 12;
    const double range_m = range_threshold_m > 0 ? range_threshold_m : kLongestDefaultRange_m;
    if (0.5 * window_m + range_m <= kMaxHalfSide_cells * resolution_m) return;
    broken.push_back(fmt::format("{} = {}: expected at least range threshold + half window over {}",
                                 name, resolution_m, kMaxHalfSide_cells));
  }
};

// What the paper intends: no-returns ignored, look-ups checked by row, headings weighted.
KartoParams corrected_params();

// What slam_toolbox, which grew out of Karto, sets in its online asynchronous mode; the method is
// Karto's.
KartoParams slam_toolbox_params();

}  // namespace corridor::karto
