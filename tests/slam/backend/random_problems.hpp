// Random problems with one optimum near the initial values, for comparing back-ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::testing {

struct RandomProblem {
  std::vector<graph::NewFactor> factors;
  graph::Values initial;
};

inline Pose2 noisy(Rng& rng, const Pose2& pose, double sigma) {
  return pose.plus({rng.normal(0, sigma), rng.normal(0, sigma), rng.normal(0, sigma)});
}

inline Eigen::Matrix3d pose_weight(double sigma) { return Eigen::Matrix3d::Identity() / sigma; }

inline std::uint32_t earlier_than(Rng& rng, std::uint32_t index) {
  return static_cast<std::uint32_t>(rng.uniform() * index);
}

// A walk of 20 poses with 15 closures under `kernel`, of which every fifth is wrong by some
// decimetres.
inline RandomProblem random_walk(std::uint64_t seed, const graph::RobustKernel& kernel = {}) {
  constexpr std::uint32_t kNumPoses = 20;
  constexpr int kNumClosures = 15;
  constexpr double kSigma = 0.03, kWrong = 0.3;
  Rng rng(seed);
  RandomProblem problem;
  std::vector<Pose2> truth{Pose2(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-3, 3))};
  problem.factors.emplace_back(
      graph::PosePrior(graph::pose_key(0), noisy(rng, truth[0], kSigma), pose_weight(kSigma)));
  const auto join = [&](std::uint32_t i, std::uint32_t j, double sigma) {
    return graph::RelativePose(graph::pose_key(i), graph::pose_key(j),
                               noisy(rng, truth[i].between(truth[j]), sigma), pose_weight(kSigma));
  };
  for (std::uint32_t j = 1; j < kNumPoses; ++j) {
    truth.push_back(truth.back() * Pose2(1, rng.normal(0, 0.1), rng.normal(0, 0.5)));
    problem.factors.emplace_back(join(j - 1, j, kSigma));
  }
  for (int k = 0; k < kNumClosures; ++k) {
    const std::uint32_t i = earlier_than(rng, kNumPoses - 1);
    problem.factors.emplace_back(
        join(i, kNumPoses - 1 - earlier_than(rng, kNumPoses - 1 - i), k % 5 == 0 ? kWrong : kSigma),
        kernel);
  }
  for (std::uint32_t i = 0; i < kNumPoses; ++i) {
    problem.initial.set_pose(i, noisy(rng, truth[i], kSigma));
  }
  return problem;
}

inline motion::ImuDelta random_delta(Rng& rng) {
  motion::ImuPreintegrator integrator(ImuModel{}, motion::ImuBias(0.01, 0.02, -0.03, 0.02));
  for (int i = 0; i < 50; ++i) {
    integrator.integrate({{}, rng.normal(0.3, 0.2), rng.normal(0, 0.5), rng.normal(0, 0.5)}, 0.01);
  }
  return integrator.delta();
}

// A key frame's true state.
struct Frame {
  Pose2 pose;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

// The frame after `delta`, whose bias is the true one.
inline Frame next_frame(const Frame& frame, const motion::ImuDelta& delta) {
  const Eigen::Matrix2d R = frame.pose.rotation();
  const Eigen::Vector2d moved =
      R.transpose() * frame.velocity_mps * delta.duration_s + delta.position_m;
  return {frame.pose * Pose2(moved.x(), moved.y(), delta.theta_rad),
          frame.velocity_mps + R * delta.velocity_mps};
}

inline const motion::ImuBias kBiasSigma(0.01, 0.05, 0.05, 0.01);
inline constexpr double kFrameSigma = 0.02;

// What IMU and wheels say between frame j and the next.
inline void add_motion(Rng& rng, std::uint32_t j, const motion::ImuDelta& delta,
                       const Pose2& by_wheels, RandomProblem& problem) {
  problem.factors.emplace_back(graph::ImuMotion(j, j + 1, delta));
  problem.factors.emplace_back(graph::BiasWalk(j, j + 1, kBiasSigma));
  motion::WheelDelta measured;
  measured.append(noisy(rng, by_wheels, kFrameSigma));
  problem.factors.emplace_back(graph::WheelMotion(graph::pose_key(j), graph::pose_key(j + 1),
                                                  graph::wheel_calibration_key(0), measured,
                                                  pose_weight(kFrameSigma)));
}

inline void add_priors(const Frame& first, RandomProblem& problem) {
  const Eigen::Vector2d velocity_sigma(0.1, 0.1);
  problem.factors.emplace_back(
      graph::PosePrior(graph::pose_key(0), first.pose, pose_weight(kFrameSigma)));
  problem.factors.emplace_back(graph::VelocityPrior(0, first.velocity_mps, velocity_sigma));
  problem.factors.emplace_back(graph::BiasPrior(0, motion::ImuBias::Zero(), kBiasSigma));
  problem.factors.emplace_back(graph::WheelCalibrationPrior(
      0, motion::WheelCalibration::Zero(), motion::WheelCalibration::Constant(0.05)));
}

// A drive of 15 key frames with poses, velocities, biases and one calibration of the wheels, and
// every type of factor; what joins distant poses is under `kernel`.
inline RandomProblem random_drive(std::uint64_t seed, const graph::RobustKernel& kernel = {}) {
  constexpr std::uint32_t kNumFrames = 15;
  Rng rng(seed);
  const double scale = rng.normal(0, 0.02);
  std::vector<Frame> truth{{Pose2(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-3, 3)),
                            {rng.normal(0, 0.5), rng.normal(0, 0.5)}}};
  RandomProblem problem;
  add_priors(truth[0], problem);
  for (std::uint32_t j = 0; j + 1 < kNumFrames; ++j) {
    const motion::ImuDelta delta = random_delta(rng);
    truth.push_back(next_frame(truth[j], delta));
    const Pose2 step = truth[j].pose.between(truth[j + 1].pose);
    add_motion(rng, j, delta,
               {step.x_m() / (1 + scale), step.y_m() / (1 + scale), step.theta_rad()}, problem);
  }
  for (std::uint32_t j = 2; j < kNumFrames; ++j) {
    const std::uint32_t i = earlier_than(rng, j);
    const Pose2 measured = noisy(rng, truth[i].pose.between(truth[j].pose), kFrameSigma);
    problem.factors.emplace_back(graph::RelativePose(graph::pose_key(i), graph::pose_key(j),
                                                     measured, pose_weight(kFrameSigma)),
                                 kernel);
  }
  problem.initial.set_wheel_calibration(0, motion::WheelCalibration::Zero());
  for (std::uint32_t j = 0; j < kNumFrames; ++j) {
    problem.initial.set_pose(j, noisy(rng, truth[j].pose, kFrameSigma));
    problem.initial.set_velocity(j, truth[j].velocity_mps);
    problem.initial.set_bias(j, motion::ImuBias::Zero());
  }
  return problem;
}

// Largest component of the step from a to b, over all variables.
inline double largest_difference(const graph::Values& a, const graph::Values& b) {
  double largest = 0;
  const auto see = [&](const auto& difference) {
    largest = std::max(largest, difference.cwiseAbs().maxCoeff());
  };
  for (const graph::Key key : a.keys()) {
    switch (key.kind) {
      case graph::VariableKind::kPose:
        see(a.pose(key.index).minus(b.pose(key.index)));
        break;
      case graph::VariableKind::kVelocity:
        see(a.velocity(key.index) - b.velocity(key.index));
        break;
      case graph::VariableKind::kBias:
        see(a.bias(key.index) - b.bias(key.index));
        break;
      case graph::VariableKind::kWheelCalibration:
        see(a.wheel_calibration(key.index) - b.wheel_calibration(key.index));
        break;
    }
  }
  return largest;
}

}  // namespace corridor::testing
