// Fusion SLAM: LiDAR, IMU and wheels in one factor graph that is solved at every key scan.
// The paper "Fusion LiDAR-Inertial-Encoder data for High-Accuracy SLAM" (its section 2) with the
// parameters of fusion_paper_params(), our extension of it with the defaults.
#pragma once

#include <memory>
#include <string>

#include "slam/backend/back_end.hpp"
#include "slam/core/slam_system.hpp"
#include "slam/fusion/fusion_params.hpp"

namespace corridor::fusion {

// Works with any subset of sensors that holds a LiDAR: without IMU the heading between scans comes
// from the wheels, without wheels the prediction keeps still. name: what its
// name() says, "fusion" or "fusion-paper". The object implements graph::GraphSource too.
std::unique_ptr<SlamSystem> make_fusion(std::string name, const FusionParams& params,
                                        const RobotModel& robot,
                                        std::unique_ptr<backend::BackEnd> back_end);

}  // namespace corridor::fusion
