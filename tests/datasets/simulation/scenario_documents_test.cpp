// The scenarios that documents show can be simulated as they stand.
#include <gtest/gtest.h>

#include "datasets/simulation/simulate.hpp"
#include "tests/support/documents.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::examples_in;
using ::corridor::testing::name_in;
using ::corridor::testing::ScratchFolder;
using ::corridor::testing::text_of_document;

TEST(ScenarioDocuments, EveryExampleOfTheReadmeGivesALogWithoutDefects) {
  const auto examples = examples_in(text_of_document("datasets/scenarios/README.md"), "toml");
  ASSERT_FALSE(examples.empty());
  for (const std::string& text : examples) {
    const ScratchFolder folder;
    const auto path = folder.write(name_in(text) + ".toml", text);
    const auto members = scenario_members(path.string());
    ASSERT_TRUE(members.has_value()) << members.error().to_line();
    for (const std::string& member : *members) {
      const auto scenario = load_scenario(member);
      ASSERT_TRUE(scenario.has_value()) << scenario.error().to_line();
      EXPECT_EQ(defects(simulate(*scenario, 1).log), std::vector<std::string>{}) << member;
    }
  }
}

// The sum that the README gives for the defaults, from the rule that refuses a route.
TEST(ScenarioDocuments, TheRoomThatTheReadmeStatesIsThatOfTheRules) {
  const ScratchFolder folder;
  const auto is_fit = [&](double room_m) {
    const double wall_y_m = 2 * room_m;
    const std::string text = fmt::format(
        "[world]\npolygons = [{{ points_m = [[0, 0], [30, 0], [30, {0}], [0, {0}]] }}]\n"
        "route_m = [[5, {1}], [25, {1}]]\n",
        wall_y_m, room_m);
    return read_scenario(folder.write("room.toml", text)).has_value();
  };
  EXPECT_TRUE(is_fit(1.0601));
  EXPECT_FALSE(is_fit(1.0599));
  EXPECT_NE(text_of_document("datasets/scenarios/README.md").find("= 1.06 m"), std::string::npos);
}

}  // namespace
}  // namespace corridor::simulation::testing
