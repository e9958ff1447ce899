// The scenarios that documents show can be simulated as they stand.
#include <gtest/gtest.h>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
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
      EXPECT_EQ(defects(simulated_log(*scenario, 1).log), std::vector<std::string>{}) << member;
    }
  }
}

// The sum that the README gives for the defaults, from the rule that refuses a route.
// Along y = 0 to x = 20 m, then along +y, in a hall with this much room on all sides of the route.
bool is_fit_with(double start_room_m, double bend_room_m, double end_room_m) {
  const ScratchFolder folder;
  const std::string text = fmt::format(
      "[world]\npolygons = [{{ closed = false, points_m = [[{0}, -9], [{0}, 9]] }},\n"
      "{{ closed = false, points_m = [[{1}, -9], [{1}, 2]] }},\n"
      "{{ closed = false, points_m = [[9, {2}], [30, {2}]] }}]\n"
      "route_m = [[0, 0], [20, 0], [20, 20]]\n",
      -start_room_m, 20 + bend_room_m, 20 + end_room_m);
  return read_scenario(folder.write("room.toml", text)).has_value();
}

TEST(ScenarioDocuments, TheRoomThatTheReadmeStatesIsThatOfTheRules) {
  EXPECT_TRUE(is_fit_with(1.09, 1.23, 1.07));
  EXPECT_FALSE(is_fit_with(1.08, 1.23, 1.07));
  EXPECT_FALSE(is_fit_with(1.09, 1.22, 1.07));
  EXPECT_FALSE(is_fit_with(1.09, 1.23, 1.05));
  EXPECT_NE(text_of_document("datasets/scenarios/README.md")
                .find("1.09 m at the start, 1.23 m at a right-angled bend and 1.06 m at the end"),
            std::string::npos);
}

}  // namespace
}  // namespace corridor::simulation::testing
