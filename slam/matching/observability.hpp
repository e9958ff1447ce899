// Which directions a scan match constrains, and what it says about those alone.
// [Zhang2016] (solution remapping by eigenvectors), [Censi2007] (information of a match):
// directions whose information is no more than noise in the normals explains are left out of the
// measurement.
#pragma once

#include <Eigen/Core>

#include "slam/core/params.hpp"
#include "slam/core/pose2.hpp"
#include "slam/matching/scan_matcher.hpp"

namespace corridor::matching {

struct ObservabilityParams {
  double min_information_ratio =
      0.003;                           // of the best direction's; below it a direction is not seen
  double min_spurious_factor = 2.0;    // times what noisy normals alone would show
  double translation_floor_m = 0.002;  // systematic error of a match
  double rotation_floor_rad = 0.0004;

  template <class V>
  static void visit(ObservabilityParams& p, V&& v) {
    v(ParamInfo{"min_information_ratio", "1",
                "a direction with less of the best one's information is unobservable", 0, 1},
      p.min_information_ratio);
    v(ParamInfo{"min_spurious_factor", "1",
                "a direction must show this many times what noise in the normals shows", 0, 1000},
      p.min_spurious_factor);
    v(ParamInfo{"translation_floor_m", "m", "systematic error of a match", 1e-6, 1},
      p.translation_floor_m);
    v(ParamInfo{"rotation_floor_rad", "rad", "systematic error of a match", 1e-6, 1},
      p.rotation_floor_rad);
  }
};

struct ObservableMatch {
  Pose2 T_map_base;  // the scan's own optimum in the directions it sees, the prior in the others
  // 3x3, base, order (x_m, y_m, theta_rad); zero along unseen directions.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_observable = 0;                                             // directions, 0 to 3
  Eigen::Vector2d weakest_direction_base = Eigen::Vector2d::UnitX();  // of translation
  double weakest_information_ratio = 0;
};

// Standard deviations of the systematic error, order (x_m, y_m, theta_rad): in these units metres
// and radians can be compared.
Eigen::Vector3d floor_sigma(const ObservabilityParams& params);

// Prior information, 3x3, order (x_m, y_m, theta_rad), that holds a pose to within the floors along
// the directions that the scan does not see; zero if it sees all. In base at match.T_map_base: used
// at a prediction it leaks half the heading's correction times that across the direction. Requires
// match.is_usable().
Eigen::Matrix3d unseen_information(const MatchResult& match, const ObservabilityParams& params);

// The match's information, 3x3, base, and along the directions that it does not see that of a
// definition, a tenth of the floors: for a frame that is where the scan is.
Eigen::Matrix3d defining_information(const ObservableMatch& match,
                                     const ObservabilityParams& params);

// Requires match.is_usable().
ObservableMatch observable_part(const MatchResult& match, const ObservabilityParams& params);

}  // namespace corridor::matching
