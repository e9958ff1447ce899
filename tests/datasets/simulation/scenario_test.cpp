#include "datasets/simulation/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;

std::string error_of(const Result<Scenario>& scenario) {
  return scenario ? "no error" : scenario.error().to_line();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Scenarios, ShippedOnesAreReadableAndNamedLikeTheirFiles) {
  const auto paths = list_scenarios();
  ASSERT_GE(paths.size(), 5u);
  for (const auto& path : paths) {
    const auto scenario = read_scenario(path);
    ASSERT_TRUE(scenario) << scenario.error().to_line();
    EXPECT_EQ(scenario->name, path.stem().string());
    EXPECT_FALSE(scenario->description.empty());
  }
}

TEST(Scenarios, PaperCorridorIsThePapersAtARangeOf4500mm) {
  const Scenario scenario = shipped_scenario("paper-corridor");
  EXPECT_EQ(scenario.world.corridor->a_m, 14.5);
  EXPECT_EQ(scenario.world.corridor->b_m, 21.0);
  EXPECT_EQ(scenario.world.corridor->c_m, 5.0);
  EXPECT_NEAR(scenario.world.corridor->alpha_rad, std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(scenario.lidar.range_max_m, 4.5);
  EXPECT_EQ(scenario.slip.num_slips, 0);
}

TEST(Scenarios, AreFoundByNameAndByPath) {
  const auto by_name = find_scenario("paper-corridor-slip");
  ASSERT_TRUE(by_name);
  EXPECT_EQ(*find_scenario(by_name->string()), *by_name);
}

TEST(Scenarios, UnknownNameIsAnsweredWithTheKnownOnes) {
  const auto missing = find_scenario("paper-coridor");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_TRUE(contains(missing.error().expected, "paper-corridor-12m"));
}

TEST(ReadScenario, KeepsTheDefaultsOfWhatIsNotGiven) {
  const ScratchFolder folder;
  const auto scenario = read_scenario(folder.write("short.toml", "[lidar]\nrange_max_m = 6\n"));
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->name, "short");
  EXPECT_EQ(scenario->lidar.range_max_m, 6);
  EXPECT_EQ(scenario->lidar.num_beams, 360);
  EXPECT_EQ(scenario->world.corridor, CorridorShape{});
}

TEST(ReadScenario, NamesEveryProblemWithItsLine) {
  const ScratchFolder folder;
  const auto path = folder.write("bad.toml",
                                 "name = \"bad\"\n"              // 1
                                 "[lidar]\n"                     // 2
                                 "range_max_m = -1.0\n"          // 3: range
                                 "num_beams = 12.5\n"            // 4: type
                                 "range = 4.5\n"                 // 5: unknown
                                 "[wheel]\n"                     // 6: unknown table
                                 "track_m = 0.3\n"               // 7
                                 "[drive]\n"                     // 8
                                 "is_return_trip = \"yes\"\n");  // 9: type
  const std::string error = error_of(read_scenario(path));
  EXPECT_TRUE(contains(error, "bad.toml:3: lidar.range_max_m = -1: expected")) << error;
  EXPECT_TRUE(
      contains(error, "bad.toml:4: lidar.num_beams is a floating-point number; expected integer"));
  EXPECT_TRUE(contains(error, "bad.toml:5: unknown key lidar.range;")) << error;
  EXPECT_TRUE(contains(error, "bad.toml:6: unknown key wheel;")) << error;
  EXPECT_TRUE(contains(error, "bad.toml:9: drive.is_return_trip is a text; expected true or false"))
      << error;
}

TEST(ReadScenario, RefusesWhatIsNoTomlWithItsLine) {
  const ScratchFolder folder;
  const auto scenario = read_scenario(folder.write("x.toml", "name = \"x\"\n[lidar\n"));
  ASSERT_FALSE(scenario);
  EXPECT_EQ(scenario.error().code, ErrorCode::kMalformed);
  EXPECT_TRUE(contains(scenario.error().where, "x.toml:2"));
}

TEST(ReadScenario, RefusesASectionThatIsAValue) {
  const ScratchFolder folder;
  const std::string error = error_of(read_scenario(folder.write("x.toml", "lidar = 4.5\n")));
  EXPECT_TRUE(contains(error, "x.toml:1: lidar is not a table")) << error;
}

TEST(ScenarioRules, RatesMustDivideTheImusRate) {
  const auto scenario = with_overrides({}, {{"lidar.rate_hz", "15"}}, "test");
  EXPECT_TRUE(contains(error_of(scenario), "lidar.rate_hz = 15: expected a whole fraction"));
}

TEST(ScenarioRules, NarrowCorridorsLeaveNoRoomForTheLateralSpread) {
  EXPECT_TRUE(contains(error_of(with_overrides({}, {{"world.c_m", "1.8"}}, "test")),
                       "drive.lateral_spread_m"));
}

TEST(ScenarioRules, HoldForTheSmallestCorridorThatASeedMayDraw) {
  const ParamValues narrow{{"world.c_m", "2.4"}};
  EXPECT_TRUE(with_overrides({}, narrow, "test"));
  ParamValues varied = narrow;
  varied["draw.length_spread"] = "0.3";
  EXPECT_FALSE(with_overrides({}, varied, "test"));
}

TEST(ScenarioRules, SlipsMustFitIntoTheDrive) {
  EXPECT_TRUE(with_overrides({}, {{"slip.num_slips", "30"}}, "test"));
  EXPECT_TRUE(contains(error_of(with_overrides({}, {{"slip.num_slips", "60"}}, "test")),
                       "slip.num_slips = 60: expected slips of"));
}

TEST(ScenarioRules, ListAllRangesBrokenAtOnce) {
  Scenario scenario;
  scenario.lidar.range_max_m = 0;
  scenario.wheels.track_m = -1;
  scenario.imu.gyro_noise_radps_rthz = -1;
  scenario.drive.speed_min_mps = 0.7;
  scenario.name.clear();
  // lidar.range_max_m breaks its range and its relation to range_min_m.
  EXPECT_EQ(violations(scenario).size(), 6u);
}

TEST(ScenarioOverrides, SetValuesByTheirKeyInTheFile) {
  const auto scenario = with_overrides(
      {}, {{"lidar.range_max_m", "6.0"}, {"world.alpha_deg", "80"}, {"draw.length_spread", "0.1"}},
      "test");
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->lidar.range_max_m, 6);
  EXPECT_NEAR(scenario->world.corridor->alpha_rad, 80 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(scenario->draw.length_spread, 0.1);
}

TEST(ScenarioOverrides, NameUnknownKeysAndUnreadableValuesTogether) {
  const std::string error = error_of(with_overrides(
      {}, {{"lidar.range", "6.0"}, {"imu.rate_hz", "fast"}, {"range_max_m", "3"}}, "--set"));
  EXPECT_TRUE(contains(error, "--set: ")) << error;
  EXPECT_TRUE(contains(error, "imu.rate_hz = \"fast\": expected number")) << error;
  EXPECT_TRUE(contains(error, "unknown scenario key lidar.range")) << error;
  EXPECT_TRUE(contains(error, "unknown scenario key range_max_m")) << error;
}

TEST(ScenarioValues, GiveTheSameScenarioBackAsOverrides) {
  Scenario scenario = shipped_scenario("paper-corridor-slip");
  scenario.world.corridor->alpha_rad = 1.234;
  ParamValues values = scenario_values(scenario);
  values.erase("name");
  values.erase("description");
  const auto again = with_overrides({}, values, "test");
  ASSERT_TRUE(again) << error_of(again);
  ParamValues values_again = scenario_values(*again);
  values_again.erase("name");
  values_again.erase("description");
  EXPECT_EQ(values_again, values);
}

}  // namespace
}  // namespace corridor::simulation::testing
