// Which values of a robot model a log, its calibration or the caller states.
#include <gtest/gtest.h>

#include "datasets/formats/log_io.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats {
namespace {

using test::golden_parts;
using test::ScratchFolder;
using test::small_log;
using test::write_text;

// The keys that are stated in a file, beside it, or in the caller's model.
RobotKeys keys_of(const std::filesystem::path& log, const ReadLogOptions& options = {}) {
  const auto found = read_log_as_found(log, options);
  EXPECT_TRUE(found.has_value()) << found.error().to_line();
  return found ? found->robot_keys : RobotKeys{};
}

TEST(StatedKeys, FlaserLinesStateNothingOfTheRobotButTheirLimitWhereItIsGiven) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", "FLASER 2 1 79 0 0 0 0 0 0 1.0 h 1.0\n");
  EXPECT_EQ(keys_of(folder / "a.clf"), RobotKeys{});
  ReadLogOptions options;
  options.no_return_range_m = 50;
  EXPECT_EQ(keys_of(folder / "a.clf", options), RobotKeys{"lidar.range_max_m"});
}

TEST(StatedKeys, CarmensRobotLasersStateTheirPoseLimitAndAccuracy) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_carmen(small_log(), folder / "a.clf"));
  EXPECT_EQ(keys_of(folder / "a.clf"), (RobotKeys{"lidar.x_m", "lidar.y_m", "lidar.yaw_deg",
                                                  "lidar.range_max_m", "lidar.range_sigma_m"}));
}

TEST(StatedKeys, BagsStateTheLimitsOfTheirScans) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_rosbag(small_log(), folder / "a.bag"));
  const RobotKeys keys = keys_of(folder / "a.bag");
  EXPECT_TRUE(states(keys, "lidar.range_min_m"));
  EXPECT_TRUE(states(keys, "lidar.range_max_m"));
  EXPECT_FALSE(states(keys, "lidar.x_m"));
  EXPECT_FALSE(states(keys, "wheels.track_m"));
}

TEST(StatedKeys, OfASidecarAddToThoseOfTheCallersModel) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", "FLASER 2 1 79 0 0 0 0 0 0 1.0 h 1.0\n");
  write_text(folder / "a.robot.toml", "[wheels]\ntrack_m = 0.5\n");
  ReadLogOptions options;
  options.robot = RobotModel{};
  options.robot_keys = {"imu.rate_hz"};
  EXPECT_EQ(keys_of(folder / "a.clf", options), (RobotKeys{"imu.rate_hz", "wheels.track_m"}));
}

TEST(StatedKeys, ARawlogsOwnModelStatesAllAndTheCallersThenNothing) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_rawlog(small_log(), folder / "a.rawlog"));
  ReadLogOptions options;
  options.robot = RobotModel{};
  options.robot_keys = {"nobody.asks"};
  const RobotKeys keys = keys_of(folder / "a.rawlog", options);
  for (const RobotEntry& entry : robot_entries(RobotModel{})) {
    EXPECT_TRUE(states(keys, entry.path())) << entry.path();
  }
  EXPECT_FALSE(states(keys, "nobody.asks"));
}

TEST(StatedKeys, LogsOfRawNumbersStateNoLimitOfTheirScans) {
  const ScratchFolder folder;
  write_text(folder / "a.robot.toml",
             "[wheels]\ntrack_m = 0.1\nleft_m_per_tick = 1e-4\nright_m_per_tick = 1e-4\n");
  write_text(folder / "a.dat", golden_parts("ticks/two-rows.dat").second);
  write_text(folder / "a.lcm", golden_parts("lcm/data.lcm").second);
  RobotKeys expected(kTickKeys.begin(), kTickKeys.end());
  EXPECT_EQ(keys_of(folder / "a.dat"), expected);
  expected.insert("lidar.scan_duration_s");  // each beam has its time
  EXPECT_EQ(keys_of(folder / "a.lcm"), expected);
}

TEST(StatedKeys, OfASidecarThatPlacesTheLidarInPartAreThatPart) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", "FLASER 2 1 79 0 0 0 0 0 0 1.0 h 1.0\n");
  write_text(folder / "a.robot.toml", "[lidar]\nscan_duration_s = 0.05\nyaw_deg = 90\n");
  EXPECT_EQ(keys_of(folder / "a.clf"), (RobotKeys{"lidar.scan_duration_s", "lidar.yaw_deg"}));
}

}  // namespace
}  // namespace corridor::formats
