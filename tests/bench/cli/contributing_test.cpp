// What CONTRIBUTING.md tells a newcomer to do works as it stands.
#include <gtest/gtest.h>

#include "tests/bench/cli/program.hpp"
#include "tests/support/documents.hpp"

namespace corridor::testing {
namespace {

// Does in `folder` what the section says: the one file of TOML as `file`, then its commands in
// order.
void expect_section_works(const ScratchFolder& folder, const std::string& title,
                          const std::string& file) {
  const std::string section = section_of(text_of_document("CONTRIBUTING.md"), title);
  const auto examples = examples_in(section, "toml");
  ASSERT_EQ(examples.size(), 1U);
  folder.write(file, examples.front());
  std::string script = "set -e\n";
  for (const std::string& commands : examples_in(section, "sh")) script += commands;
  folder.write("script.sh", script);
  const std::string command = "cd '" + folder.path().string() +
                              "' && unset CORRIDOR_BENCH_DATA && PATH='" CORRIDOR_BINARY_DIR
                              "/bin':\"$PATH\" sh script.sh >said 2>&1 </dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of(folder / "said");
  EXPECT_NE(text_of(folder / "said").find("fit, 0 suspicions"), std::string::npos);
}

TEST(Contributing, ShowsAScenarioThatRunsAndIsDrawn) {
  const ScratchFolder folder;
  expect_section_works(folder, "How to add a scenario", "office.toml");
  EXPECT_TRUE(std::filesystem::exists(folder / "office-run/index.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "office-run/figures/trajectories-office.svg"));
}

TEST(Contributing, ShowsADataSetThatRuns) {
  const ScratchFolder folder;
  expect_section_works(folder, "How to add a data set", "my-data/catalog.toml");
  EXPECT_TRUE(std::filesystem::exists(folder / "hall-run/results.sqlite"));
  const Answer list = run_program(folder, "data list --data-dir my-data");
  EXPECT_NE(list.out.find("my-data/catalog.toml"), std::string::npos) << list.out;
}

}  // namespace
}  // namespace corridor::testing
