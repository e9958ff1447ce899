// MRPT's ICP (mrpt::slam::CICP), as both of its systems here use it.
#pragma once

#include "slam/core/params.hpp"

namespace corridor::mrpt {

// Defaults: MRPT 2.5's config_files/icp-slam/icp-slam_demo_classic.ini, angles in radians.
struct IcpParams {
  bool use_levenberg_marquardt = false;
  int max_iterations = 80;
  double min_step_m = 1e-6;
  double min_step_rad = 1e-6;
  double threshold_m = 0.3;
  double threshold_rad = 0.08726646259971647;  // 5 deg
  double threshold_shrink_ratio = 0.8;
  double smallest_threshold_m = 0.05;
  bool use_unique_robust = true;
  int point_decimation = 5;

  template <class V>
  static void visit(IcpParams& p, V&& v) {
    v(ParamInfo{"use_levenberg_marquardt", "",
                "Levenberg-Marquardt on the distances of the pairs instead of the classic ICP's "
                "closed form"},
      p.use_levenberg_marquardt);
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
  }
};

}  // namespace corridor::mrpt
