// Metrics that other programs computed on the same trajectories: tests/golden/README.md says which.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/metrics/relations.hpp"
#include "bench/metrics/trajectory_errors.hpp"
#include "datasets/formats/trajectories/tum.hpp"

namespace corridor::metrics {
namespace {

// The same arithmetic on the same doubles, in another order: all digits but the last three or four.
constexpr double kRelative = 1e-11;
constexpr double kAbsolute = 1e-12;

std::filesystem::path data_dir() {
  const char* dir = std::getenv("CORRIDOR_BENCH_DATA");
  return dir == nullptr ? std::filesystem::path() : std::filesystem::path(dir);
}

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

void expect_statistics(const nlohmann::json& expected, const std::vector<double>& errors,
                       double absolute, const std::string& name) {
  const auto statistics = summarise(errors);
  ASSERT_TRUE(statistics) << name;
  const auto expect = [&](const char* key, double value, double tolerance) {
    const double golden = expected.at(key).get<double>();
    EXPECT_NEAR(value, golden, tolerance + kRelative * std::abs(golden)) << name << " " << key;
  };
  expect("rmse", statistics->rmse, absolute);
  expect("mean", statistics->mean, absolute);
  expect("median", statistics->median, absolute);
  expect("std", statistics->std, absolute);
  expect("min", statistics->min, absolute);
  expect("max", statistics->max, absolute);
  expect("sse", statistics->sse,
         2 * absolute * statistics->mean * static_cast<double>(statistics->num_errors));
}

class GoldenTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_dir() / "golden" / "evo.json")) {
      GTEST_SKIP() << "CORRIDOR_BENCH_DATA does not name a folder with golden/evo.json";
    }
  }
};

TEST_F(GoldenTest, EvosApeAndRpeAreReproduced) {
  const auto golden = read_json(data_dir() / "golden" / "evo.json");
  const auto truth = formats::read_tum(data_dir() / golden.at("truth").get<std::string>());
  ASSERT_TRUE(truth) << truth.error().to_line();
  for (const auto& expected : golden.at("cases")) {
    const auto estimate =
        formats::read_tum(data_dir() / expected.at("estimate").get<std::string>());
    ASSERT_TRUE(estimate) << estimate.error().to_line();
    const auto association = associate(*estimate, *truth, AssociationRule::kNearest);
    EXPECT_EQ(association.pairs.size(), expected.at("matched").get<std::size_t>());
    const auto expect_both = [&](const std::string& prefix, const std::string& suffix,
                                 const PoseErrors& errors) {
      const auto translation = prefix + "translation" + suffix + "_m";
      const auto rotation = prefix + "rotation" + suffix + "_deg";
      expect_statistics(expected.at(translation), errors.translation_m, kAbsolute, translation);
      expect_statistics(expected.at(rotation), errors.rotation_deg, kAbsolute, rotation);
    };
    expect_both("ape_", "_origin", absolute_pose_errors(association, Alignment::kOrigin));
    expect_both("ape_", "_se3", absolute_pose_errors(association, Alignment::kSe2));
    using enum PairSelection;
    expect_both("rpe_", "_1frame", relative_pose_errors(association, 1, kConsecutive));
    expect_both("rpe_", "_1frame_all", relative_pose_errors(association, 1, kAll));
    expect_both("rpe_", "_10frames", relative_pose_errors(association, 10, kConsecutive));
    expect_both("rpe_", "_10frames_all", relative_pose_errors(association, 10, kAll));
  }
}

TEST_F(GoldenTest, TheTwoScoresOfThePaperAreEvosOriginAlignedApe) {
  const auto golden = read_json(data_dir() / "golden" / "evo.json");
  const auto truth = formats::read_tum(data_dir() / golden.at("truth").get<std::string>());
  for (const auto& expected : golden.at("cases")) {
    const auto estimate =
        formats::read_tum(data_dir() / expected.at("estimate").get<std::string>());
    const auto scores = score_trajectory(associate(*estimate, *truth, AssociationRule::kNearest));
    EXPECT_NEAR(*scores.position_rmse_m,
                expected.at("ape_translation_origin_m").at("rmse").get<double>(), kAbsolute);
    EXPECT_NEAR(*scores.angle_rmse_deg,
                expected.at("ape_rotation_origin_deg").at("rmse").get<double>(), kAbsolute);
  }
}

// The trajectories have stamps of %.9f of doubles near 1e9 s, good to 0.1 us.
constexpr double kSameStamp_s = 1e-3;

TEST_F(GoldenTest, RelationErrorsOfTheOriginalProgramsAreReproduced) {
  const auto golden = read_json(data_dir() / "golden" / "relations.json");
  for (const auto& [name, expected] : golden.items()) {
    const auto estimate = formats::read_tum(data_dir() / "golden" / (name + ".gz"));
    ASSERT_TRUE(estimate) << estimate.error().to_line();
    const std::string log = name.substr(0, name.find('.'));
    const auto relations = formats::read_relations(data_dir() / "recorded" / (log + ".relations"));
    ASSERT_TRUE(relations) << relations.error().to_line();
    const auto scores = score_relations(*estimate, *relations, kSameStamp_s);
    EXPECT_EQ(scores.relations_skipped, expected.at("skipped").get<std::int64_t>()) << name;
    EXPECT_NEAR(*scores.relations_translation_mean_m,
                expected.at("relations_translation_mean_m").get<double>(), kAbsolute)
        << name;
    EXPECT_NEAR(*scores.relations_rotation_mean_deg,
                expected.at("relations_rotation_mean_deg").get<double>(), kAbsolute)
        << name;
  }
}

}  // namespace
}  // namespace corridor::metrics
