// iSAM2 [Kaess2012]: incremental smoothing on the Bayes tree, with two rules of its own. Steps are
// measured in standard deviations, not in metres and radians: a variable is relinearised when
// delta^T H_vv delta of its step from its linearisation point, H_vv the information that its
// factors have on it, exceeds a threshold; and back-substitution descends while the conditional
// mean of a clique moves by more than a share of its standard deviation. An update whose step is
// very large is followed by another round at once.
#pragma once

#include <array>
#include <memory>

#include "slam/backend/back_end.hpp"
#include "slam/core/params.hpp"

namespace corridor::backend {

struct Isam2Params {
  // Step beyond which a variable is relinearised, per kind of variable [standard deviations].
  double relinearize_pose = 1;
  double relinearize_velocity = 1;
  double relinearize_bias = 1;
  double relinearize_wheel_calibration = 1;
  double wildfire = 0.1;    // change that is passed on to a clique's children [standard deviations]
  double repeat_step = 30;  // step after which the update does another round [standard deviations]
  int max_rounds = 2;       // of one update
  int num_last = 10;        // newest variables, which are eliminated last
  int max_iterations = 100;             // of solve()
  double min_relative_decrease = 1e-9;  // of the cost, at which solve() stops

  template <class V>
  static void visit(Isam2Params& p, V&& v) {
    v(ParamInfo{"relinearize_pose", "1", "step in sigmas that relinearises a pose", 0},
      p.relinearize_pose);
    v(ParamInfo{"relinearize_velocity", "1", "step in sigmas that relinearises a velocity", 0},
      p.relinearize_velocity);
    v(ParamInfo{"relinearize_bias", "1", "step in sigmas that relinearises a bias", 0},
      p.relinearize_bias);
    v(ParamInfo{"relinearize_wheel_calibration", "1",
                "step in sigmas that relinearises a calibration", 0},
      p.relinearize_wheel_calibration);
    v(ParamInfo{"wildfire", "1", "change in sigmas that back-substitution passes on", 0},
      p.wildfire);
    v(ParamInfo{"repeat_step", "1", "step in sigmas after which an update does another round", 0},
      p.repeat_step);
    v(ParamInfo{"max_rounds", "1", "limit of rounds of one update", 1, 100}, p.max_rounds);
    v(ParamInfo{"num_last", "1", "newest variables that are eliminated last", 1, 1000}, p.num_last);
    v(ParamInfo{"max_iterations", "1", "limit of one solve()", 1, 1000}, p.max_iterations);
    v(ParamInfo{"min_relative_decrease", "1",
                "solve() stops when the cost falls by a smaller share", 0, 1},
      p.min_relative_decrease);
  }
};

// name(): "isam2".
std::unique_ptr<BackEnd> make_isam2(const Isam2Params& params);

}  // namespace corridor::backend
