// The include rules hold for this checkout, and each of them finds a fault put into a small tree.
#include "tests/architecture/include_rules.hpp"

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
using ::testing::UnorderedElementsAre;

const SourceTree& checkout() {
  static const SourceTree tree = read_source_tree(CORRIDOR_SOURCE_DIR);
  return tree;
}

TEST(IncludeRules, TheCheckoutIsReadWithAllItsRooms) {
  for (const char* file : {"slam/core/pose2.hpp", "slam/core/pose2.cpp", "CMakeLists.txt",
                           "bench/debian-packages.txt"}) {
    EXPECT_TRUE(checkout().has(file)) << file;
  }
  EXPECT_FALSE(checkout().has("build/release/CMakeCache.txt"));
}

TEST(IncludeRules, NoArrowOfTheCheckoutIsForbidden) {
  EXPECT_THAT(forbidden_arrows(checkout()), IsEmpty());
}

TEST(IncludeRules, HeavyPackagesStayBehindTheirDoors) {
  EXPECT_THAT(packages_outside_their_door(checkout()), IsEmpty());
}

TEST(IncludeRules, EverySourceIncludesItsOwnHeaderFirst) {
  EXPECT_THAT(own_headers_not_first(checkout()), IsEmpty());
}

TEST(IncludeRules, EveryHeaderWithoutSourceIsCompiledAloneByTheBuild) {
  std::vector<std::string> compiled;
  for (const SourceFile& file : read_source_tree(CORRIDOR_LONE_HEADERS_DIR).files) {
    for (const Include& include : includes_of(file)) compiled.push_back(include.path);
  }
  for (const std::string& header : headers_without_source(checkout())) {
    EXPECT_THAT(compiled, ::testing::Contains(header));
  }
}

TEST(IncludeRules, FindsAnArrowFromSlamToABaseline) {
  const ScratchFolder folder;
  folder.write("baselines/karto/a.hpp", "#pragma once\n");
  folder.write("slam/core/b.cpp", "\n  #  include \"baselines/karto/a.hpp\"  // why\n");
  EXPECT_THAT(forbidden_arrows(read_source_tree(folder.path())),
              ElementsAre("slam/core/b.cpp:2: slam/core/ must not include baselines/karto/a.hpp"));
}

TEST(IncludeRules, FindsArrowsBetweenBaselinesToMatchersToReportsAndToTests) {
  const ScratchFolder folder;
  folder.write("slam/matching/matcher.hpp", "");
  folder.write("slam/core/pose.hpp", "");
  folder.write("baselines/karto/a.hpp", "#include \"slam/core/pose.hpp\"\n");
  folder.write("baselines/gmapping/a.hpp", "#include \"baselines/karto/a.hpp\"\n");
  folder.write("baselines/gmapping/b.hpp", "#include \"slam/matching/matcher.hpp\"\n");
  folder.write("bench/runner/a.hpp", "#include \"reports/page.hpp\"\n");
  folder.write("reports/page.hpp", "#include \"slam/matching/matcher.hpp\"\n");
  folder.write("tests/support/a.hpp", "");
  folder.write("datasets/a.hpp", "#include \"tests/support/a.hpp\"\n");
  folder.write("bench/main.cpp", "#include \"reports/page.hpp\"\n");
  EXPECT_THAT(forbidden_arrows(read_source_tree(folder.path())),
              UnorderedElementsAre(HasSubstr("baselines/gmapping/a.hpp:1"),
                                   HasSubstr("baselines/gmapping/b.hpp:1"),
                                   HasSubstr("bench/runner/a.hpp:1"),
                                   HasSubstr("reports/page.hpp:1"), HasSubstr("datasets/a.hpp:1")));
}

TEST(IncludeRules, FindsAPathThatDoesNotStartAtTheRootAndAFileOutsideTheRooms) {
  const ScratchFolder folder;
  folder.write("slam/core/a.hpp", "");
  folder.write("slam/core/b.hpp", "#include \"a.hpp\"\n");
  folder.write("tools/c.cpp", "");
  EXPECT_THAT(forbidden_arrows(read_source_tree(folder.path())),
              ElementsAre(HasSubstr("slam/core/b.hpp:1: \"a.hpp\" is no file"),
                          HasSubstr("tools/c.cpp:1: lies in no known part")));
}

TEST(IncludeRules, FindsAPackageOutsideItsDoorAndInAHeader) {
  const ScratchFolder folder;
  folder.write("slam/graph/a.cpp", "#include <ceres/ceres.h>\n");
  folder.write("slam/backend/ceres/a.cpp", "#include <ceres/ceres.h>\n");
  folder.write("slam/backend/ceres/a.hpp", "#include <ceres/ceres.h>\n");
  folder.write("bench/metrics/map_cloud.cpp", "#include <open3d/Open3D.h>\n#include <vector>\n");
  EXPECT_THAT(packages_outside_their_door(read_source_tree(folder.path())),
              UnorderedElementsAre(HasSubstr("slam/graph/a.cpp:1: <ceres/ceres.h> belongs behind"),
                                   HasSubstr("slam/backend/ceres/a.hpp:1: <ceres/ceres.h> belongs "
                                             "in a .cpp only")));
}

TEST(IncludeRules, FindsASourceThatHidesWhatItsHeaderNeeds) {
  const ScratchFolder folder;
  folder.write("slam/core/a.hpp", "");
  folder.write("slam/core/a.cpp", "#include <vector>\n#include \"slam/core/a.hpp\"\n");
  folder.write("slam/core/b.hpp", "");
  const SourceTree tree = read_source_tree(folder.path());
  EXPECT_THAT(own_headers_not_first(tree), SizeIs(1));
  EXPECT_THAT(headers_without_source(tree), ElementsAre("slam/core/b.hpp"));
}

}  // namespace
}  // namespace corridor::architecture
