#include "bench/runner/name_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corridor::runner {
namespace {

using ::testing::ElementsAre;

DataItem item(const std::string& name, const std::string& source,
              DataKind kind = DataKind::kRecorded) {
  return {kind, name, source, "", {}};
}

std::vector<std::string> names_of(const std::vector<DataItem>& items) {
  std::vector<std::string> names;
  for (const DataItem& named : with_own_names(items)) names.push_back(named.name);
  return names;
}

TEST(NameData, LeavesNamesThatAreTheOnlyOnes) {
  EXPECT_THAT(names_of({item("run", "/a/run.log"), item("walk", "/a/walk.log")}),
              ElementsAre("run", "walk"));
}

TEST(NameData, PutsAsManyFoldersInFrontAsAreNeeded) {
  EXPECT_THAT(names_of({item("run", "/a/x/run.log"), item("run", "/b/x/run.log"),
                        item("run", "/b/y/run.log"), item("walk", "/b/y/walk.log")}),
              ElementsAre("a/x/run", "b/x/run", "y/run", "walk"));
}

TEST(NameData, KeepsTheNameOfTheCatalogueAndOfAScenario) {
  EXPECT_THAT(names_of({item("malaga", "malaga"), item("malaga", "/mine/malaga.rawlog")}),
              ElementsAre("malaga", "mine/malaga"));
  EXPECT_THAT(
      names_of({item("hall", "hall", DataKind::kSimulated), item("hall", "/mine/hall.clf")}),
      ElementsAre("hall", "mine/hall"));
}

TEST(NameData, NamesFilesOfOneFolderWithTheirSuffix) {
  EXPECT_THAT(names_of({item("run", "/a/run.clf"), item("run", "/a/run.rawlog")}),
              ElementsAre("run.clf", "run.rawlog"));
}

TEST(NameData, CountsAFileGivenTwiceOnce) {
  EXPECT_THAT(names_of({item("run", "/a/run.log"), item("run", "/a/run.log")}), ElementsAre("run"));
}

}  // namespace
}  // namespace corridor::runner
