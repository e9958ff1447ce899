// The rules about files and folders hold for this checkout, and each finds a fault in a small tree.
#include "tests/architecture/tree_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"

namespace corridor::architecture {
namespace {

using corridor::testing::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const SourceTree& checkout() {
  static const SourceTree tree = read_source_tree(CORRIDOR_SOURCE_DIR);
  return tree;
}

TEST(TreeRules, TheRootHoldsTheSevenRoomsAndTheListedFilesOnly) {
  EXPECT_THAT(strangers_at_the_root(checkout()), IsEmpty());
}

TEST(TreeRules, NoFileIsTooLong) { EXPECT_THAT(files_too_long(checkout()), IsEmpty()); }

TEST(TreeRules, EveryFolderWithCodeHasAReadme) {
  EXPECT_THAT(folders_without_readme(checkout()), IsEmpty());
}

TEST(TreeRules, EveryHeaderIsGuarded) {
  EXPECT_THAT(headers_without_pragma_once(checkout()), IsEmpty());
}

TEST(TreeRules, EverySourceIsInTheBuild) {
  EXPECT_THAT(sources_outside_the_build(checkout()), IsEmpty());
}

TEST(TreeRules, EveryLinkOfAReadmeLeadsSomewhere) {
  EXPECT_THAT(broken_links(checkout()), IsEmpty());
}

TEST(TreeRules, NothingIsMarkedAsUnfinishedAndNoPathOfOneMachineIsNamed) {
  EXPECT_THAT(forbidden_words(checkout()), IsEmpty());
}

TEST(TreeRules, SystemsDoNotPrintReadFilesTellTimeOrDrawNumbersOfTheirOwn) {
  EXPECT_THAT(forbidden_facilities(checkout()), IsEmpty());
}

TEST(TreeRules, FindsAStrangerAtTheRootButNotTheBuildFolder) {
  const ScratchFolder folder;
  folder.write("slam/core/a.hpp", "");
  folder.write("build/release/a.cpp", "");
  folder.write("README.md", "");
  folder.write("docs/a.md", "");
  EXPECT_THAT(strangers_at_the_root(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("docs: ")));
}

TEST(TreeRules, FindsAFileOfOneLineTooMany) {
  const ScratchFolder folder;
  std::string text;
  for (std::size_t line = 0; line < kMaxLinesPerFile; ++line) text += "\n";
  folder.write("slam/core/long_enough.cpp", text);
  folder.write("slam/core/too_long.cpp", text + "\n");
  EXPECT_THAT(files_too_long(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("slam/core/too_long.cpp: 401 lines")));
}

TEST(TreeRules, FindsAFolderWithoutReadmeHoweverDeepAndTakesTheTestsAsOne) {
  const ScratchFolder folder;
  folder.write("slam/graph/README.md", "");
  folder.write("slam/graph/factors/a.cpp", "");
  folder.write("slam/core/a.cpp", "");
  folder.write("slam/core/README.md", "");
  folder.write("tests/slam/core/a_test.cpp", "");
  folder.write("tests/README.md", "");
  EXPECT_THAT(folders_without_readme(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("slam/graph/factors: ")));
}

TEST(TreeRules, FindsAHeaderWithoutGuard) {
  const ScratchFolder folder;
  folder.write("slam/core/a.hpp", "// what it is\n#pragma once\n");
  folder.write("slam/core/b.hpp", "// #pragma once\n");
  EXPECT_THAT(headers_without_pragma_once(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("slam/core/b.hpp")));
}

TEST(TreeRules, FindsASourceThatIsNotBuiltEvenIfItsNameEndsAnother) {
  const ScratchFolder folder;
  folder.write("slam/core/CMakeLists.txt",
               "corridor_library(core SOURCES my_pose.cpp deep/b.cpp)\n");
  folder.write("slam/core/my_pose.cpp", "");
  folder.write("slam/core/pose.cpp", "");
  folder.write("slam/core/deep/b.cpp", "");
  EXPECT_THAT(sources_outside_the_build(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("slam/core/pose.cpp")));
}

TEST(TreeRules, FindsALinkThatLeadsNowhere) {
  const ScratchFolder folder;
  folder.write("slam/README.md", "[a](core/a.hpp) [b](../README.md#top) [c](#here)\n");
  folder.write("README.md", "[web](https://example.org/x) and [gone](slam/gone.md)\n");
  folder.write("slam/core/a.hpp", "");
  EXPECT_THAT(broken_links(read_source_tree(folder.path())),
              ElementsAre("README.md:1: leads nowhere: slam/gone.md"));
}

TEST(TreeRules, FindsMarksOfUnfinishedWorkAsWholeWordsAndPathsOfOneMachine) {
  const ScratchFolder folder;
  const std::string mark = std::string("TO") + "DO";
  folder.write("slam/core/a.cpp", "// " + mark + ": later\n// " + mark + "S is another word\n");
  folder.write("slam/README.md", std::string("See /ro") + "ot/notes.\n");
  EXPECT_THAT(forbidden_words(read_source_tree(folder.path())),
              ElementsAre("slam/README.md:1: names a path of one machine: /ro"
                          "ot/",
                          "slam/core/a.cpp:1: says " + mark));
}

TEST(TreeRules, FindsASystemThatPrintsOrTellsTime) {
  const ScratchFolder folder;
  folder.write("slam/core/a.cpp", "#include <iostream>\n");
  folder.write("slam/core/stage_clock.cpp", "std::chrono::steady_clock::now();\n");
  folder.write("baselines/karto/a.cpp", "std::chrono::steady_clock::now();\n");
  folder.write("bench/main.cpp", "#include <iostream>\n");
  EXPECT_THAT(forbidden_facilities(read_source_tree(folder.path())), SizeIs(2));
}

}  // namespace
}  // namespace corridor::architecture
