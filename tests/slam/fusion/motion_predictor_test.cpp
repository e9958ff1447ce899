#include "slam/fusion/motion_predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor::fusion {
namespace {

Timestamp at(double time_s) { return timestamp_from_seconds(time_s); }

// Predicts at 0 and tells the prediction at 0.2 s.
class MotionPredictorTest : public ::testing::Test {
 protected:
  void add_wheels(double from_s, double to_s, double speed_mps) {
    for (double t = from_s; t < to_s + 1e-9; t += 0.05) {
      predictor_.add(WheelSample{at(t), Pose2(speed_mps * t, 0, 0), std::nullopt});
    }
  }
  void add_imu(double from_s, double to_s, double rate_radps, double acceleration_mps2) {
    for (double t = from_s; t < to_s + 1e-9; t += 0.01) {
      predictor_.add(ImuSample{at(t), rate_radps, acceleration_mps2, 0});
    }
  }
  void start() {
    (void)predictor_.predict(at(0), {});
    predictor_.reset_interval(at(0), motion::ImuBias::Zero(), calibration_);
  }
  // Straight on at 0.5 m/s by the wheels, turning at 0.3 rad/s by the gyro, from 0 to 0.2 s.
  void drive_with_turning_gyro() {
    add_imu(-0.1, 0, 0, 0);
    add_wheels(-0.1, 0, 0.5);
    start();
    add_imu(0.01, 0.2, 0.3, 0);
    add_wheels(0.05, 0.2, 0.5);
  }

  RobotModel robot_;
  FusionParams params_;
  MotionPredictor predictor_{robot_, params_};
  motion::WheelCalibration calibration_ = motion::WheelCalibration::Zero();
};

TEST_F(MotionPredictorTest, TakesTheTranslationFromTheWheelsAndTheTurnFromTheGyro) {
  calibration_(motion::kScale) = 0.1;
  drive_with_turning_gyro();
  const Prediction prediction = predictor_.predict(at(0.2), {});
  EXPECT_TRUE(prediction.has_wheels);
  EXPECT_TRUE(prediction.is_turn_by_gyro);
  EXPECT_NEAR(prediction.T_last_now.x_m(), 1.1 * 0.1, 1e-9);
  EXPECT_NEAR(prediction.T_last_now.theta_rad(), 0.06, 1e-9);
}

TEST_F(MotionPredictorTest, WheelsAndImuEachTellTheMotionAlone) {
  drive_with_turning_gyro();
  MotionState state;
  state.velocity_mps = Eigen::Vector2d(1, 0);
  state.velocity_variance_m2ps2 = 0.04;
  const Prediction prediction = predictor_.predict(at(0.2), state);
  ASSERT_TRUE(prediction.by_wheels && prediction.by_imu);
  EXPECT_NEAR(prediction.by_wheels->T_last_now.x_m(), 0.1, 1e-9);
  EXPECT_NEAR(prediction.by_wheels->T_last_now.theta_rad(), 0, 1e-9);
  EXPECT_NEAR(prediction.by_imu->T_last_now.x_m(), 0.2, 1e-9);
  EXPECT_NEAR(prediction.by_imu->T_last_now.theta_rad(), 0.06, 1e-9);
  EXPECT_NEAR(prediction.by_imu->covariance(0, 0), 0.04 * 0.2 * 0.2, 1e-9);
}

TEST_F(MotionPredictorTest, TheWheelsIntervalBridgesAScanAtWhichTheyWereSilent) {
  add_wheels(-0.1, 0, 0.5);
  start();
  add_wheels(0.05, 0.2, 0.5);
  (void)predictor_.predict(at(0.2), {});
  EXPECT_NEAR(predictor_.wheel_interval()->raw_T_i_j().x_m(), 0.1, 1e-9);
  (void)predictor_.predict(at(0.6), {});
  EXPECT_FALSE(predictor_.wheel_interval().has_value());
  add_wheels(0.65, 0.8, 0.5);
  EXPECT_FALSE(predictor_.predict(at(0.8), {}).has_wheels);
  EXPECT_NEAR(predictor_.wheel_interval()->raw_T_i_j().x_m(), 0.4, 1e-9);
}

TEST_F(MotionPredictorTest, AfterALongPauseOfTheScansTheWheelsAreBack) {
  add_wheels(-0.1, 0, 0.5);
  start();
  add_wheels(0.05, 20, 0.5);
  EXPECT_NEAR(predictor_.predict(at(20), {}).T_last_now.x_m(), 10, 1e-9);
  add_wheels(20.05, 20.2, 0.5);
  const Prediction prediction = predictor_.predict(at(20.2), {});
  EXPECT_TRUE(prediction.has_wheels);
  EXPECT_NEAR(prediction.T_last_now.x_m(), 0.1, 1e-9);
  EXPECT_NEAR(predictor_.wheel_interval()->raw_T_i_j().x_m(), 10.1, 1e-9);
}

TEST_F(MotionPredictorTest, ANewDelayOfTheWheelsIsNoMotion) {
  calibration_(motion::kDelay) = 0.05;
  add_wheels(-0.1, 0.1, 0.5);
  start();
  EXPECT_NEAR(predictor_.predict(at(0.05), {}).T_last_now.x_m(), 0.025, 1e-9);
  calibration_(motion::kDelay) = 0.1;
  predictor_.reset_interval(at(0.05), motion::ImuBias::Zero(), calibration_);
  add_wheels(0.15, 0.3, 0.5);
  EXPECT_NEAR(predictor_.predict(at(0.2), {}).T_last_now.x_m(), 0.075, 1e-9);
}

TEST_F(MotionPredictorTest, AnAxleBehindTheLidarTurnsTheLidarAlongACircle) {
  calibration_(motion::kAxleX) = -0.1;
  start();
  predictor_.add(WheelSample{at(0), Pose2(), std::nullopt});
  predictor_.reset_interval(at(0), motion::ImuBias::Zero(), calibration_);
  (void)predictor_.predict(at(0), {});
  predictor_.add(WheelSample{at(0.2), Pose2(0, 0, 0.5), std::nullopt});
  const Pose2 moved = predictor_.predict(at(0.2), {}).T_last_now;
  EXPECT_NEAR(moved.x_m(), 0.1 * (std::cos(0.5) - 1), 1e-9);
  EXPECT_NEAR(moved.y_m(), 0.1 * std::sin(0.5), 1e-9);
}

TEST_F(MotionPredictorTest, WithoutAVelocityTheImuTellsNoMotion) {
  add_imu(-0.1, 0, 0, 0);
  start();
  add_imu(0.01, 0.2, 0, 0);
  EXPECT_FALSE(predictor_.predict(at(0.2), {}).by_imu.has_value());
}

TEST_F(MotionPredictorTest, CarriesTheVelocityOnByTheImuWhereTheWheelsAreSilent) {
  add_imu(-0.1, 0, 0, 0);
  start();
  add_imu(0.01, 0.2, 0, 0.5);
  MotionState state;
  state.velocity_mps = Eigen::Vector2d(1, 0);
  Prediction prediction = predictor_.predict(at(0.2), state);
  EXPECT_FALSE(prediction.has_wheels);
  EXPECT_NEAR(prediction.T_last_now.x_m(), 0.2 + 0.5 * 0.5 * 0.04, 1e-9);
  // The second scan of the interval starts faster: the velocity gained so far counts.
  add_imu(0.21, 0.4, 0, 0.5);
  prediction = predictor_.predict(at(0.4), state);
  EXPECT_NEAR(prediction.T_last_now.x_m(), 0.2 + 0.5 * 0.5 * (0.16 - 0.04), 1e-9);
  EXPECT_GT(prediction.covariance(0, 0), 0.01);
}

TEST_F(MotionPredictorTest, GoesOnWithTheLastMotionWithoutWheelsAndImu) {
  start();
  MotionState state;
  state.twist = {0.5, 0, 1.0};
  const Prediction prediction = predictor_.predict(at(0.2), state);
  EXPECT_LT((prediction.T_last_now.log() - 0.2 * state.twist).norm(), 1e-12);
  EXPECT_FALSE(prediction.is_turn_by_gyro);
}

TEST_F(MotionPredictorTest, GoesOnWithTheLastMotionInTheIntervalInWhichTheWheelsComeBack) {
  start();
  add_wheels(0.2, 0.4, 5.0);
  MotionState state;
  state.twist = {0.5, 0, 0};
  EXPECT_NEAR(predictor_.predict(at(0.2), state).T_last_now.x_m(), 0.1, 1e-12);
  EXPECT_NEAR(predictor_.predict(at(0.4), state).T_last_now.x_m(), 1.0, 1e-9);
}

TEST_F(MotionPredictorTest, DoesNotUseTheImuInTheIntervalInWhichItStarts) {
  add_wheels(-0.1, 0, 0);
  start();
  add_wheels(0.05, 0.4, 0);
  add_imu(0.1, 0.2, 1.0, 0);
  EXPECT_TRUE(predictor_.has_reading());
  EXPECT_FALSE(predictor_.has_imu());
  EXPECT_FALSE(predictor_.imu_interval().has_value());
  EXPECT_FALSE(predictor_.predict(at(0.2), {}).is_turn_by_gyro);
  predictor_.reset_interval(at(0.2), motion::ImuBias::Zero(), calibration_);
  EXPECT_TRUE(predictor_.has_imu());
  add_imu(0.21, 0.4, 1.0, 0);
  EXPECT_NEAR(predictor_.predict(at(0.4), {}).T_last_now.theta_rad(), 0.2, 1e-9);
  EXPECT_NEAR(predictor_.imu_interval()->duration_s, 0.2, 1e-9);
}

}  // namespace
}  // namespace corridor::fusion
