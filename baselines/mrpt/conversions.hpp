// Our readings as MRPT's and MRPT's results as ours. Private to this folder; MRPT's types are only
// named here, so that no header of MRPT is needed to include it.
#pragma once

#include <memory>

#include "baselines/mrpt/icp_params.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/scan.hpp"
#include "slam/core/timestamp.hpp"

namespace mrpt::maps {
class COccupancyGridMap2D;
class CSimpleMap;
}  // namespace mrpt::maps
namespace mrpt::obs {
class CObservation2DRangeScan;
class CObservationOdometry;
}  // namespace mrpt::obs
namespace mrpt::poses {
class CPose2D;
class CPose3D;
}  // namespace mrpt::poses
namespace mrpt::slam {
class CICP;
}

namespace corridor::mrpt {

// Beams without return keep their raw range and are marked invalid. MRPT's fan is symmetric about
// the sensor's pose, so that the pose is turned to the middle of the fan.
std::shared_ptr<::mrpt::obs::CObservation2DRangeScan> to_mrpt(const LaserScan& scan,
                                                              double range_sigma_m);
std::shared_ptr<::mrpt::obs::CObservationOdometry> to_mrpt(Timestamp stamp,
                                                           const Pose2& T_odom_base);
::mrpt::poses::CPose2D to_mrpt(const Pose2& pose);
::mrpt::slam::CICP to_mrpt(const IcpParams& params);

// x, y and yaw.
Pose2 to_pose2(const ::mrpt::poses::CPose3D& pose);

// Cells that MRPT never touched (exactly even odds) are unobserved; it keeps no hits.
GridMap to_grid_map(const ::mrpt::maps::COccupancyGridMap2D& grid);

// MRPT's grid of scans at their poses; empty without scans.
GridMap to_grid_map(const ::mrpt::maps::CSimpleMap& key_scans, double cell_size_m);

}  // namespace corridor::mrpt
