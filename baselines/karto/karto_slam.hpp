// Karto-style graph SLAM as a system of the suite: key scans matched to a running local map, links,
// loop closing and sparse pose adjustment. [Konolige2010]; facts of the shipped program in README.
// It uses wheels and LiDAR only, and never revises an accepted edge.
#pragma once

#include <memory>

#include "baselines/karto/karto_params.hpp"
#include "slam/backend/back_end.hpp"
#include "slam/core/slam_system.hpp"
#include "slam/graph/graph_source.hpp"

namespace corridor::karto {

// Scans without wheel odometry near their stamp, and scans without a single beam in range, are
// tracked with the last odometry and never become key scans; counters: "scans_without_odometry",
// "unusable_scans".
class KartoSlam final : public SlamSystem, public graph::GraphSource {
 public:
  // `params` must have no violations; requires back_end and num_threads >= 1, on which the estimate
  // does not depend. Only the LiDAR's limit is read from
  // `robot`.
  KartoSlam(const KartoParams& params, const RobotModel& robot,
            std::unique_ptr<backend::BackEnd> back_end, int num_threads);
  ~KartoSlam() override;

  [[nodiscard]] std::string_view name() const override { return "karto"; }
  Result<StepReport> on_event(const SensorEvent& event) override;
  Result<SlamEstimate> finish() override;

  [[nodiscard]] const graph::FactorGraph& solved_graph() const override;
  [[nodiscard]] const graph::Values& solved_values() const override;
  [[nodiscard]] std::vector<Timestamp> pose_stamps() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

std::unique_ptr<SlamSystem> make_karto(const KartoParams& params, const RobotModel& robot,
                                       std::unique_ptr<backend::BackEnd> back_end, int num_threads);

}  // namespace corridor::karto
