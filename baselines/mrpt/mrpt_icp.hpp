// MRPT's own ICP-SLAM (mrpt::slam::CMetricMapBuilderICP) as a third-party reference.
// The algorithm is MRPT's, unchanged; this door only converts events, poses and the map.
#pragma once

#include <memory>

#include "baselines/mrpt/icp_params.hpp"
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
  IcpParams icp;
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
    IcpParams::visit(p.icp, v);
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
