#include "bench/runner/folder_lock.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

TEST(FolderLock, IsHeldByOneAtATime) {
  const testing::ScratchFolder folder;
  auto first = FolderLock::take(folder.path());
  ASSERT_TRUE(first.has_value());
  const auto second = FolderLock::take(folder.path());
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(second.error().where, folder.path().string());
  EXPECT_EQ(second.error().what, "another run is writing to this folder");
  { const FolderLock moved(std::move(*first)); }
  EXPECT_TRUE(FolderLock::take(folder.path()).has_value());
}

TEST(FolderLock, MakesTheFolderAndLeavesNothingInIt) {
  const testing::ScratchFolder folder;
  const fs::path target = folder / "a" / "b";
  { ASSERT_TRUE(FolderLock::take(target).has_value()); }
  EXPECT_TRUE(fs::is_directory(target));
  EXPECT_TRUE(fs::is_empty(target));
}

TEST(FolderLock, IsNotHeldByAFileThatAKilledRunLeft) {
  const testing::ScratchFolder folder;
  folder.write(".lock", "");
  EXPECT_TRUE(FolderLock::take(folder.path()).has_value());
}

TEST(FolderLock, SaysThatAFileIsNoFolder) {
  const testing::ScratchFolder folder;
  const fs::path file = folder.write("file", "");
  const auto lock = FolderLock::take(file);
  ASSERT_FALSE(lock.has_value());
  EXPECT_EQ(lock.error().where, file.string());
}

}  // namespace
}  // namespace corridor::runner
