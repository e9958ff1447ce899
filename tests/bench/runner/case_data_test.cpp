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

TEST_F(ScorableDataset, RefusesRelationsOfAnotherClock) {
  folder_.write("run.relations", "1.0 2000 1 0 0 0 0 0\n");
  const auto refused = load();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what, "none of 1 relations has scans at both of its times");
  folder_.write("run.relations", "1.0 1.1 0.1 0 0 0 0 0\n");
  EXPECT_TRUE(load().has_value());
}

}  // namespace
}  // namespace corridor::runner
