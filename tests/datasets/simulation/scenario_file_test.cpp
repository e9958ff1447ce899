// Bases, presets and families of scenario files.
#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;

template <class T>
std::string error_of(const Result<T>& result) {
  return result ? "no error" : result.error().to_line();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ScenarioFiles, EveryMemberOfEveryShippedOneLoadsUnderItsName) {
  std::size_t num_members = 0;
  for (const auto& path : list_scenarios()) {
    const auto members = scenario_members(path.stem().string());
    ASSERT_TRUE(members) << error_of(members);
    for (const std::string& member : *members) {
      const auto scenario = load_scenario(member);
      ASSERT_TRUE(scenario) << member << ": " << error_of(scenario);
      EXPECT_EQ(scenario->name, member);
      EXPECT_TRUE(violations(*scenario).empty());
      ++num_members;
    }
  }
  EXPECT_GT(num_members, list_scenarios().size() + 20);
}

TEST(ScenarioFiles, EveryShortMemberOfAFamilyGivesALogWithoutDefects) {
  for (const auto& path : list_scenarios()) {
    const auto members = scenario_members(path.stem().string());
    ASSERT_TRUE(members) << error_of(members);
    if (members->size() == 1) continue;  // simulated in simulate_test.cpp
    for (const std::string& member : *members) {
      const auto scenario = load_scenario(member);
      ASSERT_TRUE(scenario) << error_of(scenario);
      if (scenario->world.corridor->b_m > 40) continue;
      const Simulated simulated = simulate(*scenario, 1);
      EXPECT_EQ(defects(simulated.log), std::vector<std::string>{}) << member;
      EXPECT_EQ(simulated.log.provenance.notes, std::vector<std::string>{}) << member;
    }
  }
}

TEST(ScenarioFamily, MembersAreNamedByTheirValueAndHaveIt) {
  const auto members = scenario_members("corridor-range");
  ASSERT_TRUE(members) << error_of(members);
  EXPECT_EQ(members->front(), "corridor-range@3.5");
  EXPECT_EQ(load_scenario("corridor-range@4")->lidar.range_max_m, 4);
  EXPECT_EQ(load_scenario("corridor-range@12")->lidar.range_max_m, 12);
  EXPECT_EQ(*scenario_members("corridor-range@12"), std::vector<std::string>{"corridor-range@12"});
  EXPECT_EQ(*scenario_members("paper-corridor"), std::vector<std::string>{"paper-corridor"});
}

TEST(ScenarioFamily, UnknownMembersAndTheFamilyItselfAreAnsweredWithItsMembers) {
  for (const char* name : {"corridor-range", "corridor-range@7"}) {
    const auto scenario = load_scenario(name);
    ASSERT_FALSE(scenario);
    EXPECT_EQ(scenario.error().code, ErrorCode::kNotFound);
    EXPECT_TRUE(contains(scenario.error().expected, "3.5 4 4.5")) << error_of(scenario);
  }
  EXPECT_FALSE(load_scenario("paper-corridor@3"));
  EXPECT_FALSE(scenario_members("no-such-scenario"));
}

TEST(ScenarioFamily, IsFoundByItsPathToo) {
  const ScratchFolder folder;
  const auto path = folder.write("mine.toml",
                                 "base = \"paper-corridor\"\n[family]\nkey = \"wheels.track_m\"\n"
                                 "values = [0.3, 0.4]\n");
  const auto members = scenario_members(path.string());
  ASSERT_TRUE(members) << error_of(members);
  ASSERT_EQ(members->size(), 2u);
  const auto scenario = load_scenario(members->back());
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->wheels.track_m, 0.4);
  EXPECT_EQ(scenario->name, "mine@0.4");
}

TEST(ScenarioFamily, NamesWhatIsWrongWithItsTable) {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of(scenario_members(folder.write("f.toml", text).string()));
  };
  EXPECT_TRUE(contains(error("[family]\nvalues = [1]\n"), "f.toml:1: family.key"));
  EXPECT_TRUE(contains(error("[family]\nkey = \"a.b\"\n"), "family.values"));
  EXPECT_TRUE(contains(error("[family]\nkey = \"a.b\"\nvalues = [1, \"x\"]\n"),
                       "f.toml:3: family.values: expected numbers"));
  EXPECT_TRUE(contains(error("[family]\nkey = \"a.b\"\nvalues = [1]\nstep = 2\n"),
                       "f.toml:4: unknown key family.step"));
  const auto path = folder.write("g.toml", "[family]\nkey = \"a.b\"\nvalues = [1]\n");
  EXPECT_TRUE(contains(error_of(load_scenario(path.string() + "@1")), "unknown scenario key a.b"));
}

TEST(ScenarioBase, GivesItsValuesUnlessTheFileSetsThem) {
  const ScratchFolder folder;
  const auto path =
      folder.write("mine.toml", "base = \"paper-corridor-slip\"\n[slip]\nratio = 0.3\n");
  const auto scenario = read_scenario(path);
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->name, "mine");
  EXPECT_EQ(scenario->slip.num_slips, 3);
  EXPECT_EQ(scenario->slip.ratio, 0.3);
}

TEST(ScenarioBase, MayLieBesideTheFile) {
  const ScratchFolder folder;
  folder.write("first.toml", "[lidar]\nrange_max_m = 7\n");
  const auto scenario = read_scenario(folder.write("second.toml", "base = \"first.toml\"\n"));
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->lidar.range_max_m, 7);
}

TEST(ScenarioBase, CirclesAreRefused) {
  const ScratchFolder folder;
  const auto first = folder.write("first.toml", "base = \"second.toml\"\n");
  folder.write("second.toml", "base = \"first.toml\"\n");
  EXPECT_TRUE(contains(error_of(read_scenario(first)), "scenarios on one another"));
  const auto own = folder.write("own.toml", "base = \"own.toml\"\n");
  EXPECT_TRUE(contains(error_of(read_scenario(own)), "scenarios on one another"));
}

TEST(ScenarioBase, ThatIsNotThereIsAnsweredWithItsLineAndTheNearestOnes) {
  const ScratchFolder folder;
  const auto scenario =
      read_scenario(folder.write("x.toml", "name = \"x\"\nbase = \"paper-coridor\"\n"));
  ASSERT_FALSE(scenario);
  const std::string error = error_of(scenario);
  EXPECT_TRUE(contains(error, "x.toml:2: base = \"paper-coridor\": no such scenario")) << error;
  EXPECT_TRUE(contains(error, "nearest names: paper-corridor, paper-corridor-12m")) << error;
}

TEST(ScenarioBase, ItsCorridorIsChangedKeyByKey) {
  const ScratchFolder folder;
  folder.write("first.toml", "[world]\nb_m = 20\nc_m = 4\n");
  const auto scenario =
      read_scenario(folder.write("second.toml", "base = \"first.toml\"\n[world]\nc_m = 3.5\n"));
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->world.corridor->b_m, 20);
  EXPECT_EQ(scenario->world.corridor->c_m, 3.5);
}

TEST(ScenarioBase, ItsDrawingIsTakenAsAWholeOrWithAnotherRoute) {
  const ScratchFolder folder;
  folder.write("hall.toml",
               "[world]\nmaterials = [{ name = \"wall\" }]\n"
               "polygons = [{ points_m = [[0, 0], [20, 0], [20, 6], [0, 6]] }]\n"
               "arcs = [{ centre_m = [10, 5], radius_m = 0.2 }]\nroute_m = [[2, 2], [18, 2]]\n");
  const auto read = [&](const std::string& world) {
    return read_scenario(folder.write("x.toml", "base = \"hall.toml\"\n[world]\n" + world));
  };
  const auto back = read("route_m = [[18, 2], [2, 2]]\n");
  ASSERT_TRUE(back) << error_of(back);
  EXPECT_EQ(back->world.walls.size(), 4U);
  EXPECT_EQ(back->world.arcs.size(), 1U);
  EXPECT_EQ(back->world.route_m.front().x(), 18);
  const auto other = read(
      "polygons = [{ points_m = [[0, 0], [9, 0], [9, 6], [0, 6]] }]\nroute_m = [[2, 3], [7, 3]]\n");
  ASSERT_TRUE(other) << error_of(other);
  EXPECT_TRUE(other->world.arcs.empty() && other->world.materials.empty()) << "drawn anew";
  for (const char* key : {"a_m = 12\n", "materials = []\n"}) {
    EXPECT_TRUE(contains(error_of(read(key)), "x.toml:3: world.")) << error_of(read(key));
    EXPECT_TRUE(contains(error_of(read(key)), "on a base that is drawn")) << error_of(read(key));
  }
}

TEST(ScenarioFiles, AreCalledAsTheNameInThem) {
  const ScratchFolder folder;
  EXPECT_TRUE(read_scenario(folder.write("hall.toml", "name = \"hall\"\n")));
  const auto other = read_scenario(folder.write("zzz.toml", "\nname = \"hall\"\n"));
  EXPECT_TRUE(contains(error_of(other), "zzz.toml:2: name = \"hall\"; expected \"zzz\""))
      << error_of(other);
}

TEST(ScenarioFiles, AMisspeltNameIsAnsweredWithTheNearestOnes) {
  const std::string error = error_of(load_scenario("rectangel"));
  EXPECT_TRUE(contains(error, "nearest names: rectangle, ")) << error;
}

TEST(ScenarioTable, SaysUnitRangeAndMeaningOfEveryValue) {
  const Scenario scenario;
  const auto rows = scenario_table(scenario);
  EXPECT_EQ(rows.size() + 2, scenario_values(scenario).size()) << "all but name and description";
  for (const ParamRow& row : rows) {
    EXPECT_EQ(row.value, scenario_values(scenario).at(row.name));
    EXPECT_FALSE(row.meaning.empty()) << row.name;
  }
}

TEST(SensorPresets, ComeBeforeTheTablesOwnKeys) {
  const ScratchFolder folder;
  const auto scenario = read_scenario(folder.write("x.toml",
                                                   "[imu]\ngyro_bias_sigma_radps = 0.5\n"
                                                   "preset = \"consumer\"\n"));
  ASSERT_TRUE(scenario) << error_of(scenario);
  EXPECT_EQ(scenario->imu.gyro_bias_sigma_radps, 0.5);
  EXPECT_EQ(scenario->imu.gyro_noise_radps_rthz, 8.7e-5);
}

TEST(SensorPresets, UnknownOnesAreAnsweredWithTheKnownOnesAndTheLine) {
  const ScratchFolder folder;
  const auto error = error_of(
      read_scenario(folder.write("x.toml", "[lidar]\nrate_hz = 10\npreset = \"lms-100\"\n")));
  EXPECT_TRUE(contains(error, "x.toml:3: unknown preset lidar.lms-100")) << error;
  EXPECT_TRUE(contains(error, "rplidar-a1 urg-04lx utm-30lx")) << error;
}

TEST(SensorPresets, OfATableThatHasNoneAreAnsweredWithTheTablesThatHave) {
  const ScratchFolder folder;
  const auto error = error_of(read_scenario(folder.write("x.toml", "[people]\npreset = \"x\"\n")));
  EXPECT_TRUE(contains(error,
                       "x.toml:2: there are no presets of [people]; expected one of [imu] "
                       "[lidar] [wheels]"))
      << error;
}

TEST(SensorPresets, AllCarryAScenario) {
  const ScratchFolder folder;
  for (const auto& [section, names] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"lidar", {"urg-04lx", "rplidar-a1", "utm-30lx"}},
           {"imu", {"consumer", "industrial"}},
           {"wheels", {"good", "poor"}}}) {
    for (const std::string& name : names) {
      auto scenario =
          read_scenario(folder.write("x.toml", "[" + section + "]\npreset = \"" + name + "\"\n"));
      ASSERT_TRUE(scenario) << error_of(scenario);
      scenario->drive.stays = true;
      scenario->drive.spin_turns = 0.5;
      EXPECT_EQ(defects(simulate(*scenario, 1).log), std::vector<std::string>{}) << name;
    }
  }
}

TEST(ScenarioRules, BrakingOnASlipperyFloorNeedsMoreRoom) {
  EXPECT_TRUE(with_overrides({}, {{"world.c_m", "2.6"}}, "test"));
  const auto slippery =
      with_overrides({}, {{"world.c_m", "2.6"}, {"drive.friction_limit_mps2", "0.1"}}, "test");
  EXPECT_TRUE(contains(error_of(slippery), "m of room on both sides")) << error_of(slippery);
}

}  // namespace
}  // namespace corridor::simulation::testing
