// An IMU's readings as a continuous motion: bridges the time between readings, and knows where
// there were none.
#pragma once

#include <optional>

#include "slam/core/imu.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/motion/imu_preintegration.hpp"

namespace corridor::motion {

class ImuTrack {
 public:
  explicit ImuTrack(const ImuModel& model) : preintegrator_(model, ImuBias::Zero()) {}

  // A reading stands for the time since the one before it, and on from its stamp until the next; in
  // either direction for no longer than three of the intervals in which readings come, at most
  // kMaxHold_s. What lies beyond went unmeasured.
  void add(const ImuSample& sample);
  // Integrates up to a moment. Before the first reading nothing is integrated.
  void advance_to(Timestamp stamp);
  // Starts a new delta where the last one ends, with these biases.
  void reset(const ImuBias& bias) { preintegrator_.reset(bias); }

  [[nodiscard]] bool has_reading() const { return last_.has_value(); }
  [[nodiscard]] const ImuDelta& delta() const { return preintegrator_.delta(); }

  static constexpr double kMaxHold_s = 0.3;

 private:
  void integrate(const ImuSample& sample, double duration_s);

  ImuPreintegrator preintegrator_;
  std::optional<ImuSample> last_;
  std::optional<Timestamp> integrated_until_;
  double hold_s_ = kMaxHold_s;
};

}  // namespace corridor::motion
