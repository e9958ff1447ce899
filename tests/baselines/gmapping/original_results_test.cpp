// Held to the original program's results on the recorded corridor logs, where those are.
// original-results/NAME.gmapping-seed1.txt: which scans it used; rmse.txt: position RMSE of twelve
// seeds, 30 particles, shipped parameters, first poses aligned.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "baselines/gmapping/gmapping_slam.hpp"
#include "bench/statistics/quantiles.hpp"
#include "datasets/formats/log_io.hpp"
#include "tests/support/corridor_logs.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::gmapping {
namespace {

constexpr int kNumSeeds = 10;

// Lines "LOG gmapping seed N position_rmse_m VALUE ...".
std::vector<double> original_rmse_m(const std::filesystem::path& file, const std::string& log) {
  std::vector<double> values;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string name;
    std::string program;
    std::string skipped;
    double rmse_m = 0;
    fields >> name >> program >> skipped >> skipped >> skipped >> rmse_m;
    if (fields && name == log && program == "gmapping") values.push_back(rmse_m);
  }
  return values;
}

std::vector<bool> original_key_scans(const std::filesystem::path& file) {
  std::vector<bool> is_key_scan;
  for (const testing::OriginalPose& pose : testing::read_original_poses(file)) {
    is_key_scan.push_back(pose.is_key_scan);
  }
  return is_key_scan;
}

struct Outcome {
  double rmse_m = 0;
  std::vector<bool> is_key_scan;
};

Outcome run(const SensorLog& log, std::uint64_t seed) {
  Outcome outcome;
  const auto slam = make_gmapping({}, log.robot, Rng(seed), 1);
  for (const SensorEvent& event : log.events) {
    const Result<StepReport> report = slam->step(event);
    EXPECT_TRUE(report.has_value());
    if (std::holds_alternative<LaserScan>(event)) {
      outcome.is_key_scan.push_back(report->is_key_scan);
    }
  }
  const Trajectory path = slam->finish()->trajectory;
  const Pose2 T_truth_map = log.truth->front().T_map_base * path.front().T_map_base.inverse();
  double sum_m2 = 0;
  for (const TrajectoryPose& pose : path.poses()) {
    const Pose2 truth = log.truth->interpolate(pose.stamp).value_or(Pose2());
    sum_m2 +=
        ((T_truth_map * pose.T_map_base).translation_m() - truth.translation_m()).squaredNorm();
  }
  outcome.rmse_m = std::sqrt(sum_m2 / static_cast<double>(path.size()));
  return outcome;
}

// Rank-sum statistic of Mann and Whitney in standard deviations: how far the ranks of `a` among all
// are above what they would be if both came from one distribution. Values are all different.
double rank_sum_z(const std::vector<double>& a, const std::vector<double>& b) {
  double num_above = 0;
  for (const double x : a) {
    num_above +=
        static_cast<double>(std::count_if(b.begin(), b.end(), [x](double y) { return x > y; }));
  }
  const auto n = static_cast<double>(a.size());
  const auto m = static_cast<double>(b.size());
  return (num_above - n * m / 2) / std::sqrt(n * m * (n + m + 1) / 12);
}

TEST(RankSum, OfTwoSamplesAgreesWithTheValuesComputedByHand) {
  // Interleaved: 1 + 2 + 3 = 6 of 9 pairs; variance 3 * 3 * 7 / 12.
  EXPECT_NEAR(rank_sum_z({2, 4, 6}, {1, 3, 5}), 1.5 / std::sqrt(5.25), 1e-12);
  EXPECT_NEAR(rank_sum_z({1, 2, 3}, {4, 5, 6}), -4.5 / std::sqrt(5.25), 1e-12);
}

class OriginalGmapping : public ::testing::TestWithParam<const char*> {};

TEST_P(OriginalGmapping, UsesTheSameScansAndIsAsAccurateOnTheCorridorLog) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "ten runs of a log take minutes with sanitizers";
#endif
  const std::string name = GetParam();
  const std::string log_name = "corridor/" + name + ".clf.gz";
  const auto log_file = testing::recorded_file(log_name);
  const auto rmse_file = testing::recorded_file("corridor/original-results/rmse.txt");
  const auto key_scan_file =
      testing::recorded_file("corridor/original-results/" + name + ".gmapping-seed1.txt");
  if (!log_file || !rmse_file || !key_scan_file) {
    GTEST_SKIP() << testing::missing_data_message(log_name);
  }
  const Result<SensorLog> log = formats::read_log(*log_file);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_TRUE(log->truth.has_value());
  const std::vector<double> original_m = original_rmse_m(*rmse_file, name);
  const std::vector<bool> original_is_key_scan = original_key_scans(*key_scan_file);
  ASSERT_EQ(original_m.size(), 12u);

  std::vector<double> rmse_m;
  for (std::uint64_t seed = 1; seed <= kNumSeeds; ++seed) {
    const Outcome outcome = run(*log, seed);
    rmse_m.push_back(outcome.rmse_m);
    EXPECT_EQ(outcome.is_key_scan, original_is_key_scan);
  }
  // Two-sided at 1 %.
  const double z = rank_sum_z(rmse_m, original_m);
  EXPECT_LT(std::abs(z), 2.576);
  const auto [smallest, largest] = std::minmax_element(original_m.begin(), original_m.end());
  const double median_m = statistics::median(rmse_m).value();
  EXPECT_GE(median_m, *smallest);
  EXPECT_LE(median_m, *largest);
  RecordProperty("rank_sum_z", std::to_string(z));
  RecordProperty("median_m", std::to_string(median_m));
}

INSTANTIATE_TEST_SUITE_P(CorridorLogs, OriginalGmapping,
                         ::testing::ValuesIn(testing::kCorridorLogs), testing::test_name);

}  // namespace
}  // namespace corridor::gmapping
