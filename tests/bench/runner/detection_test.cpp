#include "bench/runner/detection.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace corridor::runner {
namespace {

// Scans at 1, 2, ... s; one letter each: '1' alarm, '0' no alarm, '-' no flag given.
std::vector<HealthSample> slip_flags(const std::string& letters) {
  std::vector<HealthSample> health;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    HealthSample sample;
    sample.stamp = timestamp_from_seconds(static_cast<double>(i + 1));
    if (letters[i] != '-') sample.is_slip_detected = letters[i] == '1';
    health.push_back(sample);
  }
  return health;
}

TEST(Detection, CountsAlarmsScansAndLatencyByHand) {
  // The slip touches the times (2, 3], (3, 4] and (4, 5]; alarms at 4, 5 and 8 s.
  simulation::SimulationTruth truth;
  truth.slips = {{2.5, 4.2, 0.6}};
  results::RunResult result;
  score_detection(slip_flags("00011001"), truth, result);
  EXPECT_DOUBLE_EQ(result.slip_precision.value(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(result.slip_recall.value(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(result.slip_latency_s.value(), 1.5);
}

TEST(Detection, LeavesNullWhatHasNoMeaning) {
  simulation::SimulationTruth truth;
  results::RunResult result;
  score_detection(slip_flags("000"), truth, result);
  EXPECT_FALSE(result.slip_precision.has_value());
  EXPECT_FALSE(result.slip_recall.has_value());
  EXPECT_FALSE(result.slip_latency_s.has_value());
  EXPECT_FALSE(result.degeneracy_recall.has_value());
  truth.slips = {{0.5, 2.5, 0.6}};
  score_detection({}, truth, result);
  EXPECT_FALSE(result.slip_recall.has_value()) << "a system without flags was not asked";
}

TEST(Detection, JudgesDegeneracyOnlyWhereTheTruthSays) {
  std::vector<HealthSample> health(4);
  for (std::size_t i = 0; i < health.size(); ++i) {
    health[i].stamp = timestamp_from_seconds(static_cast<double>(i + 1));
    health[i].is_degenerate = i >= 2;
  }
  simulation::SimulationTruth truth;
  results::RunResult result;
  score_detection(health, truth, result);
  EXPECT_FALSE(result.degeneracy_recall.has_value());
  truth.degenerate = {{2.9, 4.5, 0.0}};
  score_detection(health, truth, result);
  EXPECT_DOUBLE_EQ(result.degeneracy_precision.value(), 1.0);
  EXPECT_DOUBLE_EQ(result.degeneracy_recall.value(), 1.0);
}

TEST(Detection, CountsScansThatSeeNothingAsDegenerate) {
  std::vector<HealthSample> health(2);
  for (std::size_t i = 0; i < health.size(); ++i) {
    health[i].stamp = timestamp_from_seconds(static_cast<double>(i + 1));
    health[i].is_degenerate = false;
  }
  simulation::SimulationTruth truth;
  truth.degenerate = {{1.9, 2.0, std::nullopt}};
  results::RunResult result;
  score_detection(health, truth, result);
  EXPECT_DOUBLE_EQ(result.degeneracy_recall.value(), 0.0);
}

}  // namespace
}  // namespace corridor::runner
