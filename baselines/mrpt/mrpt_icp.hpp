// MRPT's own ICP-SLAM (mrpt::slam::CMetricMapBuilderICP) as a third-party reference.
// The algorithm is MRPT's, unchanged; this door only converts events, poses and the map.
#pragma once

#include <memory>

#include "slam/core/params.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::mrpt {

// Defaults: MRPT 2.5's config_files/icp-slam/icp-slam_demo_classic.ini, angles in radians.
struct MrptIcpParams {
  double localization_linear_m = 0.2;
  double localization_angular_rad = 0.08726646259971647;  // 5 deg
  double insertion_linear_m = 1.2;
  double insertion_angular_rad = 0.7853981633974483;  // 45 deg
  double min_goodness = 0.40;
  int max_iterations = 80;
  double min_step_m = 1e-6;
  double min_step_rad = 1e-6;
  double threshold_m = 0.3;
  double threshold_rad = 0.08726646259971647;  // 5 deg
  double threshold_shrink_ratio = 0.8;
  double smallest_threshold_m = 0.05;
  bool use_unique_robust = true;
  int point_decimation = 5;
  double min_point_distance_m = 0.05;
  double map_cell_size_m = 0.05;

  template <class V>
  static void visit(MrptIcpParams& p, V&& v) {
    v(ParamInfo{"localization_linear_m", "m", "path since the last match that makes ICP run", 0,
                100},
      p.localization_linear_m);
    v(ParamInfo{"localization_angular_rad", "rad", "the same for rotation", 0, 7},
      p.localization_angular_rad);
    v(ParamInfo{"insertion_linear_m", "m",
                "path since the last insertion that adds a scan to the map", 0, 100},
      p.insertion_linear_m);
    v(ParamInfo{"insertion_angular_rad", "rad", "the same for rotation", 0, 7},
      p.insertion_angular_rad);
    v(ParamInfo{"min_goodness", "1", "share of paired points that makes a match count", 0, 1},
      p.min_goodness);
    v(ParamInfo{"max_iterations", "1", "iterations of ICP", 1, 100000}, p.max_iterations);
    v(ParamInfo{"min_step_m", "m", "a smaller translation ends the iterations", 0, 1},
      p.min_step_m);
    v(ParamInfo{"min_step_rad", "rad", "a smaller rotation ends the iterations", 0, 1},
      p.min_step_rad);
    v(ParamInfo{"threshold_m", "m", "first largest distance of a pair", 1e-6, 100}, p.threshold_m);
    v(ParamInfo{"threshold_rad", "rad", "grows that distance for far points", 0, 3},
      p.threshold_rad);
    v(ParamInfo{"threshold_shrink_ratio", "1", "factor on the threshold after each convergence",
                0.01, 0.999},
      p.threshold_shrink_ratio);
    v(ParamInfo{"smallest_threshold_m", "m", "threshold at which ICP ends", 1e-6, 100},
      p.smallest_threshold_m);
    v(ParamInfo{"use_unique_robust", "", "pairs must be each other's closest"},
      p.use_unique_robust);
    v(ParamInfo{"point_decimation", "1", "every n-th point of the scan is paired", 1, 10000},
      p.point_decimation);
    v(ParamInfo{"min_point_distance_m", "m", "closer points of the map are dropped", 0, 10},
      p.min_point_distance_m);
    v(ParamInfo{"map_cell_size_m", "m",
                "cell of the occupancy grid made at the end; it is not matched against", 0.01, 1},
      p.map_cell_size_m);
  }
};

// What works on corridors and recorded logs, where the shipped values lose the way: see README.
MrptIcpParams dense_icp_params();

// Requires parameters without violations. It keeps no graph: the final path is the online one.
std::unique_ptr<SlamSystem> make_mrpt_icp(const MrptIcpParams& params, const RobotModel& robot);

}  // namespace corridor::mrpt
