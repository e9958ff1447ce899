// MRPT's own RBPF-SLAM (mrpt::slam::CMetricMapBuilderRBPF) as a third-party reference: a particle
// filter with one map per particle, whose proposal is either drawn by rejection from the motion
// model with the scan's likelihood [Blanco2010] or the Gaussian of an ICP match against the
// particle's map, as in [Grisetti2007]. The algorithm is MRPT's, unchanged; this door only converts
// events, poses and the map.
#pragma once

#include <memory>

#include "baselines/mrpt/icp_params.hpp"
#include "slam/core/params.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::mrpt {

// Defaults: MRPT 2.5's config_files/rbpf-slam/gridmapping_optimal_sampling.ini, angles in radians;
// what that file does not name (the odometry's noise among it) keeps the library's default.
struct MrptRbpfParams {
  bool use_icp_proposal = false;
  int num_particles = 25;
  double localization_linear_m = 1.0;
  double localization_angular_rad = 0.6981317007977318;  // 40 deg
  double insertion_linear_m = 1.0;
  double insertion_angular_rad = 0.6981317007977318;  // 40 deg
  double resample_threshold_ratio = 0.5;
  double likelihood_power = 0.01;
  int num_search_samples = 400;
  double cell_size_m = 0.07;
  double insertion_range_m = 35;
  double max_occupancy_certainty = 0.60;
  bool use_no_returns = true;
  int likelihood_decimation = 5;
  double likelihood_sigma_m = 0.20;
  double likelihood_max_distance_m = 0.30;
  double likelihood_hit_weight = 0.999;
  double likelihood_random_weight = 0.001;
  double likelihood_range_m = 30;
  double min_goodness = 0.70;
  IcpParams icp;
  double min_point_distance_m = 0.05;
  double points_sigma_m = 0.05;
  double points_max_distance_m = 5;
  int points_decimation = 10;

  template <class V>
  static void visit(MrptRbpfParams& p, V&& v) {
    v(ParamInfo{"use_icp_proposal", "",
                "propose poses by ICP against each particle's map of points; without, by optimal "
                "sampling over a grid map"},
      p.use_icp_proposal);
    v(ParamInfo{"num_particles", "1", "number of particles", 1, 10000}, p.num_particles);
    v(ParamInfo{"localization_linear_m", "m", "odometry displacement that makes the filter run", 0,
                100},
      p.localization_linear_m);
    v(ParamInfo{"localization_angular_rad", "rad", "the same for rotation", 0, 7},
      p.localization_angular_rad);
    v(ParamInfo{"insertion_linear_m", "m", "odometry displacement that adds a scan to the maps", 0,
                100},
      p.insertion_linear_m);
    v(ParamInfo{"insertion_angular_rad", "rad", "the same for rotation", 0, 7},
      p.insertion_angular_rad);
    v(ParamInfo{"resample_threshold_ratio", "1",
                "resample when the effective number of particles falls below this share", 0, 1},
      p.resample_threshold_ratio);
    v(ParamInfo{"likelihood_power", "1", "likelihoods are raised to this power", 1e-6, 10},
      p.likelihood_power);
    v(ParamInfo{"num_search_samples", "1", "optimal sampling: samples of the proposal per particle",
                1, 100000},
      p.num_search_samples);
    v(ParamInfo{"cell_size_m", "m", "side of a cell of the map", 0.01, 1}, p.cell_size_m);
    v(ParamInfo{"insertion_range_m", "m", "optimal sampling: largest range written into the maps",
                0.1, 1000},
      p.insertion_range_m);
    v(ParamInfo{"max_occupancy_certainty", "1",
                "optimal sampling: probability that one beam gives a cell", 0.5, 0.999},
      p.max_occupancy_certainty);
    v(ParamInfo{"use_no_returns", "", "optimal sampling: beams without return clear space"},
      p.use_no_returns);
    v(ParamInfo{"likelihood_decimation", "1",
                "optimal sampling: every n-th beam is used in the likelihood", 1, 10000},
      p.likelihood_decimation);
    v(ParamInfo{"likelihood_sigma_m", "m", "optimal sampling: standard deviation of a hit", 1e-4,
                100},
      p.likelihood_sigma_m);
    v(ParamInfo{"likelihood_max_distance_m", "m",
                "optimal sampling: how far an end point looks for an occupied cell", 1e-3, 100},
      p.likelihood_max_distance_m);
    v(ParamInfo{"likelihood_hit_weight", "1", "optimal sampling: weight of the hit term", 0, 1},
      p.likelihood_hit_weight);
    v(ParamInfo{"likelihood_random_weight", "1", "optimal sampling: weight of the random term", 0,
                1},
      p.likelihood_random_weight);
    v(ParamInfo{"likelihood_range_m", "m", "optimal sampling: largest range used in the likelihood",
                0.1, 1000},
      p.likelihood_range_m);
    v(ParamInfo{"min_goodness", "1",
                "ICP proposal: share of paired points below which odometry is used instead", 0, 1},
      p.min_goodness);
    IcpParams::visit(p.icp, v);
    v(ParamInfo{"min_point_distance_m", "m", "ICP proposal: closer points of the map are dropped",
                0, 10},
      p.min_point_distance_m);
    v(ParamInfo{"points_sigma_m", "m", "ICP proposal: standard deviation of a point in the weights",
                1e-4, 100},
      p.points_sigma_m);
    v(ParamInfo{"points_max_distance_m", "m",
                "ICP proposal: how far a point looks for one of the map in the weights", 1e-3, 100},
      p.points_max_distance_m);
    v(ParamInfo{"points_decimation", "1", "ICP proposal: every n-th point counts in the weights", 1,
                10000},
      p.points_decimation);
  }
};

// MRPT 2.5's config_files/rbpf-slam/gridmapping_RBPF_ICPbased_intel.ini: proposals by ICP.
MrptRbpfParams icp_rbpf_params();

// Proposals by the classic ICP with every point, and denser matches and maps, as the 4.5 m corridor
// needs them: see README.
MrptRbpfParams dense_rbpf_params();

// Requires parameters without violations. MRPT draws from one generator per thread; it is set from
// `rng` before every step, so that runs in one process do not disturb each other. Online pose: the
// particles' mean. finish(): the most likely particle's path, scans between its updates filled in
// from odometry, and its map; with ICP proposals the particles have maps of points, and the grid is
// made of the scans in them at the particles' mean poses.
std::unique_ptr<SlamSystem> make_mrpt_rbpf(const MrptRbpfParams& params, const RobotModel& robot,
                                           Rng rng);

}  // namespace corridor::mrpt
