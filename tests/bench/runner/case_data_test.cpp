#include "bench/runner/case_data.hpp"

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

// Two scans, at 1.0 s and 1.1 s.
constexpr const char* kTinyLog =
    "ODOM 0 0 0 0.2 0 0 1.0 host 1.0\n"
    "FLASER 8 1 1 1 1 1 1 1 1 0 0 0 0 0 0 1.0 host 1.0\n"
    "ODOM 0.1 0 0 0.2 0 0 1.1 host 1.1\n"
    "FLASER 8 1 1 1 1 1 1 1 1 0.1 0 0 0.1 0 0 1.1 host 1.1\n";

class ScorableDataset : public ::testing::Test {
 protected:
  ScorableDataset() : log_(folder_.write("run.clf", kTinyLog).string()) {}
  [[nodiscard]] auto load() const { return load_scorable_dataset(log_, {}); }

  testing::ScratchFolder folder_;
  std::string log_;
};

TEST_F(ScorableDataset, NeedsNoTruth) { EXPECT_TRUE(load().has_value()); }

TEST_F(ScorableDataset, TakesATruthThatMeetsOneScan) {
  folder_.write("run.tum", "1.1 0 0 0 0 0 0 1\n2000 1 0 0 0 0 0 1\n");
  EXPECT_TRUE(load().has_value());
}

TEST_F(ScorableDataset, RefusesATruthOfAnotherClockAndSaysBothSpans) {
  folder_.write("run.tum", "1000 0 0 0 0 0 0 1\n2000 1 0 0 0 0 0 1\n");
  const auto refused = load();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what,
            "no stamp in common with the scans (truth: 1000.000 s to 2000.000 s, scans: 1.000 s to "
            "1.100 s)");
  EXPECT_EQ(refused.error().where, (folder_ / "run.tum").string());
}

TEST_F(ScorableDataset, RefusesAWorldThatCannotBeRead) {
  folder_.write("run.truth.toml", "[world\n");
  const auto refused = load();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().where, (folder_ / "run.truth.toml").string() + ":1");
}

TEST_F(ScorableDataset, RefusesRelationsOfAnotherClock) {
  folder_.write("run.relations", "1.0 2000 1 0 0 0 0 0\n");
  const auto refused = load();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what, "none of 1 relations has scans at both of its times");
  folder_.write("run.relations", "1.0 1.1 0.1 0 0 0 0 0\n");
  EXPECT_TRUE(load().has_value());
}

// A scenario whose LiDAR clock is off by a stated number gives the data of one whose clock is
// right.
TEST(CaseData, OfASimulatedLidarClockThatIsStatedIsOnTheWheelsClock) {
  const testing::ScratchFolder folder;
  const auto load = [&folder](const std::string& lidar) {
    CaseSpec spec;
    spec.data_source = folder
                           .write("clock.toml",
                                  "name = \"clock\"\ndescription = \"a clock\"\n"
                                  "base = \"paper-corridor\"\n" +
                                      lidar)
                           .string();
    spec.data_seed = 3;
    return load_case_data(spec, {});
  };
  const auto plain = load("");
  ASSERT_TRUE(plain.has_value()) << plain.error().to_line();
  const auto moved = load("[lidar]\ntime_offset_s = 0.0307\n");
  ASSERT_TRUE(moved.has_value()) << moved.error().to_line();
  EXPECT_EQ(moved->log.robot.lidar.time_offset_s, 0);
  ASSERT_EQ(moved->log.truth->size(), plain->log.truth->size());
  for (std::size_t i = 0; i < plain->log.truth->size(); ++i) {
    EXPECT_EQ((*moved->log.truth)[i].stamp, (*plain->log.truth)[i].stamp);
  }
  ASSERT_EQ(moved->log.events.size(), plain->log.events.size());
  for (std::size_t i = 0; i < plain->log.events.size(); ++i) {
    ASSERT_EQ(stamp_of(moved->log.events[i]), stamp_of(plain->log.events[i])) << i;
  }
  ASSERT_TRUE(plain->simulation_truth->degenerate && moved->simulation_truth->degenerate);
  const auto& expected = *plain->simulation_truth->degenerate;
  const auto& found = *moved->simulation_truth->degenerate;
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_FALSE(expected.empty());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].begin_s, expected[i].begin_s);
    EXPECT_EQ(found[i].end_s, expected[i].end_s);
  }
}

}  // namespace
}  // namespace corridor::runner
